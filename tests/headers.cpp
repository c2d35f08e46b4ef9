// Compiles the headers that tests share (CMakeLists.txt).
