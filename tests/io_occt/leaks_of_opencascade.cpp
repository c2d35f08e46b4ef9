// OpenCASCADE leaks memory when the tests make shapes: this list suppresses these leaks in the leak sanitizer.

extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libTK\n"; }
