// Stands for cad_file.cpp, find_cad_reader.cpp and cad_reader.cpp in builds without files and child processes.

#include "io/cad/cad_input.h"
#include "io/cad/cad_reader.h"
#include "tessera/cad.h"
#include "tessera/guard.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {

Result<CadInput> CadInput::open(const std::filesystem::path& path) { return read_file(path).status(); }
Result<std::string> CadInput::file() { return read_file(name_).status(); }

Result<std::string> reader_for(const std::filesystem::path&, std::string_view format) {
  return Status(StatusCode::unsupported, std::string(format) +
                                             " files are read by the program tessera-cad-reader, which this build of "
                                             "Tessera does not start");
}

Result<Model> run_cad_reader(const CadReaderRun& run) { return reader_for({}, run.format).status(); }

Result<std::filesystem::path> find_cad_reader(const CadOptions&) {
  return guarded([]() -> Result<std::filesystem::path> { return reader_for({}, "CAD").status(); });
}

}}  // namespace tessera::abi_0_1
