#pragma once
// A wavy sheet of bicubic patches as a .bpt file, for models larger than memory: it is written row by row.

#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "io/file/output_file.h"

namespace tessera::bench {

/// Writes rows x columns patches over the unit square each, with waves of 0.3 in height. Neighbours share the control
/// points of their border. About 400 bytes per patch.
inline Status write_wavy_sheet(const std::filesystem::path& path, std::size_t rows, std::size_t columns) {
  Result<OutputFile> out = OutputFile::make(path);
  if (!out) return out.status();
  const auto text_of = [](double value) {
    char digits[32];
    return std::string(digits, std::to_chars(digits, digits + 32, value, std::chars_format::fixed, 6).ptr);
  };
  // Control point (i, j) of the sheet stands at (i / 3, j / 3).
  std::vector<std::string> y;
  std::vector<double> wave;
  for (std::size_t j = 0; j <= 3 * columns; ++j) {
    y.push_back(text_of(double(j) / 3) + ' ');
    wave.push_back(0.15 * std::sin(1.3 * double(j)) + 0.1 * std::sin(0.011 * double(j)));
  }
  out->write_number(rows * columns);
  out->write('\n');
  for (std::size_t row = 0; row < rows && !out->failed(); ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      out->write("3 3\n");
      for (std::size_t i = 3 * row; i <= 3 * row + 3; ++i) {
        const std::string x = text_of(double(i) / 3) + ' ';
        const double height = 0.15 * std::cos(0.9 * double(i));
        for (std::size_t j = 3 * column; j <= 3 * column + 3; ++j) {
          out->write(x);
          out->write(y[j]);
          out->write_number(height + wave[j], 5);
          out->write('\n');
        }
      }
    }
  return out->commit();
}

}  // namespace tessera::bench
