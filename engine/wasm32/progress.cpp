// A function for tsr_run.progress that calls the host: in WebAssembly a host's functions have no addresses.

/// Tells the host how far the call is, from 0 to 1. `user` is tsr_run.user.
extern "C" [[clang::import_module("tessera"), clang::import_name("progress")]] void tessera_host_progress(double share,
                                                                                                          void* user);

/// Returns the address of the function.
extern "C" [[clang::export_name("tessera_progress")]] void (*tessera_progress())(double, void*) {
  return tessera_host_progress;
}
