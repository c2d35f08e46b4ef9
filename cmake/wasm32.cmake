# The toolchain file for WebAssembly, for browsers and Node: clang 19 with the C and C++ libraries of Debian, without
# emscripten. The preset "wasm" names it; tools/setup.sh --for wasm installs what it needs. engine/wasm32 holds what the
# C++ library lacks.

set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_CXX_COMPILER clang++-19)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_AR llvm-ar-19)
set(CMAKE_RANLIB llvm-ranlib-19)
# JSON, muParser and running out of memory are exceptions, which become a Status.
set(CMAKE_CXX_FLAGS_INIT "-fwasm-exceptions")
# Nothing of this machine's own libraries is linked.
set(CMAKE_FIND_ROOT_PATH /usr/lib/wasm32-wasi)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
