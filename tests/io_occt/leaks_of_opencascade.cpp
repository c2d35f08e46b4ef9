// Where the tests make shapes themselves, OpenCASCADE leaks some of its own: the leak sanitizer is told so.

extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libTK\n"; }
