// Models of files and of bytes, with options, and files as bytes, of the C interface.

#include "c/mesh.h"
#include "tessera/cad.h"
#include "tessera/io.h"
#include "tessera/tessera_c_files.h"

using namespace tessera;

namespace tessera { inline namespace abi_0_1 { namespace {

CStatus wanted_options(const tsr_read_options* given, const Execution& execution, ModelReadOptions& out) {
  tsr_read_options own;
  tsr_read_defaults(&own);
  if (CStatus status = read_struct("tsr_read_options", given, own); status.code) return status;
  if (CStatus status = check_member("tsr_read_options", "step_reader", own.step_reader, TSR_STEP_READER_EITHER);
      status.code)
    return status;
  if (own.format) out.format = own.format;
  if (own.cad_reader) out.cad.reader = own.cad_reader;
  out.cad.step_reader = static_cast<StepReader>(own.step_reader);
  out.cad.cancel = execution.cancel;
  out.cad.progress = execution.progress;
  return {};
}

/// Reads a model with these options.
template <class Read>
CStatus give_read(tsr_model** out, const tsr_read_options* options, const tsr_run* run, const Read& read) {
  return run_work(run, [&](const Execution& execution) -> CStatus {
    ModelReadOptions wanted;
    if (CStatus status = wanted_options(options, execution, wanted); status.code) return status;
    return give_model(out, read(wanted));
  });
}

CStatus give_bytes(tsr_bytes** out, Result<std::string>&& bytes) {
  if (!bytes) return bytes.status();
  return give(out, std::make_shared<CBytes>(*std::move(bytes)));
}

/// Calls make(), which gives the bytes, if there is a place for them and a name.
template <class Make>
tsr_status make_bytes(tsr_bytes** bytes, const char* name, const Make& make) {
  if (bytes) *bytes = nullptr;
  return c_call([&]() -> CStatus {
    if (!bytes || !name) return null_pointer(bytes ? "name" : "bytes");
    return make();
  });
}

}}}  // namespace tessera::abi_0_1

extern "C" {

void tsr_read_defaults(tsr_read_options* options) {
  if (!options) return;
  *options = {};
  options->struct_size = sizeof *options;
  options->step_reader = static_cast<std::int32_t>(CadOptions().step_reader);
}

tsr_status tsr_model_read_file(tsr_model** model, const char* path, const tsr_read_options* options,
                               const tsr_run* run) {
  if (model) *model = nullptr;
  return c_call([&]() -> CStatus {
    if (!model || !path) return null_pointer(model ? "path" : "model");
    return give_read(model, options, run, [&](const ModelReadOptions& wanted) { return read_model(path, wanted); });
  });
}

tsr_status tsr_model_read_bytes(tsr_model** model, const void* bytes, size_t size, const char* name,
                                const tsr_read_options* options, const tsr_run* run) {
  if (model) *model = nullptr;
  return c_call([&]() -> CStatus {
    if (!model || !bytes) return null_pointer(model ? "bytes" : "model");
    const std::string_view content(static_cast<const char*>(bytes), size);
    return give_read(model, options, run, [&](const ModelReadOptions& wanted) {
      return parse_model(content, name ? name : "bytes", wanted);
    });
  });
}

const void* tsr_bytes_data(const tsr_bytes* bytes, size_t* size) {
  const Held<CBytes> of(bytes);
  if (size) *size = of ? of->bytes.size() : 0;
  return of ? of->bytes.data() : nullptr;
}

tsr_status tsr_mesh_bytes(tsr_bytes** bytes, const tsr_mesh* mesh, const tsr_set* set, const char* name) {
  return make_bytes(bytes, name, [&]() -> CStatus {
    Mesh copy;
    if (CStatus status = named_copy(mesh, set, copy); status.code) return status;
    return give_bytes(bytes, mesh_bytes(copy, name));
  });
}

tsr_status tsr_model_mesh_bytes(tsr_bytes** bytes, const tsr_model* model, const tsr_mesh* const* meshes,
                                const tsr_set* const* sets, size_t count, const char* name) {
  return make_bytes(bytes, name, [&]() -> CStatus {
    const Held<CModel> of(model);
    if (!of) return of.error();
    if (!meshes || !sets) return null_pointer(meshes ? "sets" : "meshes");
    MeshAssembly assembly;
    if (CStatus status = assembly_of(of->model, meshes, sets, count, assembly); status.code) return status;
    return give_bytes(bytes, assembly_bytes(assembly, name));
  });
}

tsr_status tsr_model_bytes(tsr_bytes** bytes, const tsr_model* model, const char* name) {
  return make_bytes(bytes, name, [&]() -> CStatus {
    const Held<CModel> of(model);
    if (!of) return of.error();
    std::string written;
    const Result<WrittenModel> facts = write_model_bytes(of->model, name, written);
    return facts ? give_bytes(bytes, std::move(written)) : CStatus(facts.status());
  });
}

tsr_status tsr_model_cad_bytes(tsr_bytes** bytes, const tsr_model* model) {
  return make_bytes(bytes, "", [&]() -> CStatus {
    const Held<CModel> of(model);
    if (!of) return of.error();
    return give_bytes(bytes, cad_model_bytes(of->model));
  });
}

}  // extern "C"
