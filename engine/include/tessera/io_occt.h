#pragma once
// Reads STEP and IGES files through OpenCASCADE. Belongs to tessera::io_occt, which is built where OpenCASCADE is
// installed.
//
// Surfaces: every face becomes a B-spline or NURBS surface, in millimetres whatever the file's unit.
//
// - Exact up to rounding: splines and Bezier surfaces with their own points, knots and parameters (periodic ones on
//   unclamped knots); planes, cylinders, cones, spheres, tori, surfaces of revolution and of extrusion.
// - Fitted, with a warning that states how well: offset surfaces, and those swept along hyperbolas and offset curves.
// - Parameters are the file's, except along circles and ellipses: there they are those of rational arcs of at most 90
//   degrees, with the angle's value at their ends.
// - The domain is the face's rectangle of parameters, which may be a part of the knots' domain.
// - A face whose edges run inside that rectangle is trimmed. Its trims hold its loops: the edges' own splines wherever
//   the parameters are the file's, else curves within 1e-9 of the range. Trims are not honoured yet, which a warning
//   says.
// - A face that the file reverses has u and v swapped, so that normals of solids point outwards.
// - `placement` is the face's place in the assembly; `name` is the product's (STEP) or the entity's (IGES).
// - A face that can't be read is left out, and a warning says why: degrees above max_degree, an unbounded plane, input
//   that OpenCASCADE rejects (such as weights that are not positive).
//
// Errors: the first warning's reason (no face is left), io_error, parse_error (the reason is OpenCASCADE's),
// invalid_weight (IGES: OpenCASCADE would read another surface), unsupported (the extension; not a regular file),
// out_of_memory, internal (OpenCASCADE crashed).
//
// Process: OpenCASCADE may crash on damaged files and keeps global state, so it runs in a forked child process. The
// child has no standard streams and bounds on memory (512 MiB plus 256 times the file) and on computing time (120
// seconds plus one for every 20 kB). Its damage ends with it, and calls from any number of threads are independent.
// Programs that must not fork (say, because another of their threads uses OpenCASCADE at the time) should not call
// these functions.

#include <filesystem>

#include "tessera/model.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// Reads a STEP file: AP203, AP214 or AP242 (ISO 10303-21). Errors: as above.
Result<Model> read_step(const std::filesystem::path& path);
/// Reads an IGES 5.x file in its fixed form, columns of 80 characters. Errors: as above.
Result<Model> read_iges(const std::filesystem::path& path);
/// Reads either, by the extension in any case of letters: .step, .stp, .iges, .igs. Errors: as above, unsupported
/// (another extension).
Result<Model> read_cad(const std::filesystem::path& path);
/// Whether read_cad() knows the extension.
bool is_cad_file(const std::filesystem::path& path);

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
