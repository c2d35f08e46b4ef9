#pragma once
// STEP and IGES files, read through OpenCASCADE: tessera::io_occt, which is built where OpenCASCADE is installed.
//
// Every face becomes a B-spline or NURBS surface, in millimetres whatever the file's unit. Exact, to rounding: splines
// and Bezier surfaces with their own points, knots and parameters (periodic ones on unclamped knots); planes, cylinders,
// cones, spheres, tori, surfaces of revolution and of extrusion. Parameters along circles and ellipses are those of
// rational arcs of at most 90 degrees, with the angle's value at their ends; all others are the file's. Offset surfaces,
// and those swept along hyperbolas and offset curves, are fitted: a warning states how well.
// - The domain is the face's rectangle of parameters, which may be a part of the knots' domain.
// - A face whose edges run inside that rectangle is trimmed: trims hold its loops, the edges' own splines wherever the
//   parameters are the file's, else within 1e-9 of the range. Trims are not honoured yet, which a warning says.
// - A face that the file reverses has u and v swapped, so that normals of solids point outwards.
// - placement is the face's place in the assembly; name the product's (STEP) or the entity's (IGES).
// - A face that can't be read is left out, and a warning says why: degrees above max_degree, an unbounded plane, what
//   OpenCASCADE refuses (weights that are not positive among it). Errors: no face is left (the first reason), io_error,
//   parse_error (the reason is OpenCASCADE's), invalid_weight (IGES: OpenCASCADE would read another surface),
//   unsupported (the extension; what is no regular file), out_of_memory, internal (OpenCASCADE crashed).
//
// OpenCASCADE is not proof against damaged files, and keeps global state. So it works in a forked child process, which
// has no standard streams and a bound on memory (512 MiB and 256 times the file) and on computing (120 seconds and one
// for every 20 kB). What it breaks ends with it; calls from any number of threads don't know of each other. Programs
// that must not fork (say, because another thread of theirs uses OpenCASCADE at the time) should not call these.

#include <filesystem>

#include "tessera/model.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// STEP: AP203, AP214, AP242 (ISO 10303-21).
Result<Model> read_step(const std::filesystem::path& path);
/// IGES 5.x in its fixed form, columns of 80 characters.
Result<Model> read_iges(const std::filesystem::path& path);
/// By the extension, in any case of letters: .step, .stp, .iges, .igs.
Result<Model> read_cad(const std::filesystem::path& path);
/// Whether read_cad knows the extension.
bool is_cad_file(const std::filesystem::path& path);

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
