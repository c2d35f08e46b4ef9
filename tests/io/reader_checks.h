#pragma once
// Checks for every reader of a text format: other layouts of the same text, cuts at every byte, spoiled bytes.

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <string_view>

#include "tessera/io.h"

namespace tessera::test {

using Parser = Result<Model> (*)(std::string_view text, std::string_view name);

/// The message of a text that must fail with `code`.
inline std::string error_of(Parser parse, std::string_view text, StatusCode code = StatusCode::parse_error) {
  const Result<Model> model = parse(text, "m");
  EXPECT_FALSE(model.ok()) << text;
  if (model.ok()) return {};
  EXPECT_EQ(model.status().code(), code) << model.status().message();
  return model.status().message();
}

inline Model model_of(Parser parse, std::string_view text) {
  Result<Model> model = parse(text, "m");
  EXPECT_TRUE(model.ok()) << model.status().message() << '\n' << text;
  return model ? *std::move(model) : Model{};
}

/// Checks that both have the same surfaces at the same places: equal to the last bit wherever they are evaluated.
inline void expect_same(const Model& a, const Model& b, const std::string& what) {
  ASSERT_EQ(a.surfaces.size(), b.surfaces.size()) << what;
  EXPECT_EQ(a.warnings.size(), b.warnings.size()) << what;
  for (std::size_t k = 0; k < a.surfaces.size(); ++k) {
    const ModelSurface &x = a.surfaces[k], &y = b.surfaces[k];
    EXPECT_EQ(x.name, y.name) << what;
    EXPECT_EQ(x.placement, y.placement) << what;
    EXPECT_EQ(x.trims, y.trims) << what;
    ASSERT_EQ(kind_name(x.surface), kind_name(y.surface)) << what;
    ASSERT_EQ(domain(x.surface), domain(y.surface)) << what;
    for (const auto& [s, t] : {std::pair(0.0, 0.0), {0.25, 0.8}, {0.7, 0.4}, {1.0, 1.0}}) {
      const Domain d = domain(x.surface);
      const Result<SurfaceJet> p = evaluate_jet(x, d.u_at(s), d.v_at(t)), q = evaluate_jet(y, d.u_at(s), d.v_at(t));
      ASSERT_TRUE(p.ok() && q.ok()) << what;
      EXPECT_EQ(p->position, q->position) << what << ", surface " << k;
      EXPECT_EQ(p->du, q->du) << what << ", surface " << k;
    }
  }
}

/// CRLF, a byte order mark, tabs, blanks before the ends of lines, no end of the last line.
inline void expect_layout_does_not_matter(Parser parse, const std::string& text) {
  const Model plain = model_of(parse, text);
  std::string windows = "\xEF\xBB\xBF", tabs, blanks, open = text;
  for (const char c : text) {
    windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    tabs += c == ' ' ? '\t' : c;
    blanks += c == '\n' ? std::string(" \t\n\n") : std::string(1, c);
  }
  open.erase(open.find_last_not_of('\n') + 1);
  expect_same(plain, model_of(parse, windows), "CRLF and a byte order mark");
  expect_same(plain, model_of(parse, tabs), "tabs");
  expect_same(plain, model_of(parse, blanks), "blanks and empty lines");
  expect_same(plain, model_of(parse, open), "no end of the last line");
}

/// A truncated text must be read, or fail with a line, and never has more surfaces than the whole.
inline void expect_cuts_are_harmless(Parser parse, const std::string& text) {
  const std::size_t surfaces = model_of(parse, text).surfaces.size();
  for (std::size_t bytes = 0; bytes < text.size(); ++bytes) {
    // Memory of its own, so that a sanitizer sees a read beyond the end.
    const std::string cut = text.substr(0, bytes);
    const Result<Model> model = parse(std::string_view(cut.data(), cut.size()), "m");
    if (model.ok()) {
      ASSERT_LE(model->surfaces.size(), surfaces) << "cut at byte " << bytes;
    } else {
      ASSERT_EQ(model.status().message().rfind("m:", 0), 0u) << model.status().message();
    }
  }
}

/// Texts with a few wrong bytes must be read or fail, with their name in the message.
inline void expect_spoiled_bytes_are_harmless(Parser parse, const std::string& text, int tries = 3000) {
  std::mt19937 random(5);
  const std::string likely = "0123456789.-+eE \n\"[]#nai";
  for (int k = 0; k < tries; ++k) {
    std::string spoiled = text;
    for (int n = 0; n < 3; ++n) {
      spoiled[random() % spoiled.size()] = k % 2 == 0 ? static_cast<char>(random()) : likely[random() % likely.size()];
    }
    const Result<Model> model = parse(spoiled, "m");
    if (!model) {
      EXPECT_TRUE(model.status().code() == StatusCode::parse_error || model.status().code() == StatusCode::unsupported)
          << model.status().message();
    }
  }
}

}  // namespace tessera::test
