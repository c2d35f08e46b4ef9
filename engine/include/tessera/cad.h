#pragma once
// Reads STEP, IGES and BREP files, from the disk or from memory.
//
// Readers: CadOptions::step_reader chooses who reads STEP.
//
// - Tessera's own reads STEP in this process, by the threads of the caller's TBB arena. It needs no program and no
//   other library.
// - OpenCASCADE's reads STEP, IGES and BREP in the program tessera-cad-reader, which alone uses OpenCASCADE. It is
//   built and installed with Tessera where OpenCASCADE is found. Where it is missing, the error names the command that
//   builds it.
//
// Packed files: a file that begins as gzip or as a zip archive does is unpacked, whatever its extension, such as .stpz,
// .stp.gz or .igs.gz. An archive must hold one file. The unpacked size is limited as for read_model().
//
// Models that were read before: cad_model_bytes() keeps a model as bytes, which are read in place of the file.
//
// Surfaces: every face becomes a B-spline or NURBS surface, in millimetres whatever the file's unit. BREP files have no
// unit; their numbers are kept.
//
// - Exact up to rounding: splines and Bezier surfaces with their own points, knots and parameters (periodic ones on
//   unclamped knots); planes, cylinders, cones, spheres, tori, surfaces of revolution and of extrusion.
// - Fitted, with a warning that states how well: offset surfaces that are no quadrics; by OpenCASCADE's reader also
//   those swept along hyperbolas, which Tessera's has exactly, and along offset curves. A face that its reader can
//   neither state nor fit is left out, with a warning.
// - Parameters are the file's, except along circles and ellipses: there they are those of rational arcs of at most 90
//   degrees, with the angle's value at their ends.
// - The domain is the face's rectangle of parameters, which may be a part of the knots' domain.
// - A face whose edges run inside that rectangle is trimmed. Its trims hold its loops.
// - Tessera's reader makes the curves of loops from the edges and does not use those that the file states: exact on
//   planes; straight along a parameter; else of degree 7 at the edge's own parameter, within 1e-3 of the file's
//   uncertainty of the points of the surface that are nearest to the edge, as sampled. A sphere whose face has an edge
//   through a pole takes another axis. A sphere or torus without edges has some along its sides.
// - OpenCASCADE's reader takes the curves that the file states, or those that OpenCASCADE makes: the edges' own splines
//   wherever the parameters are the file's, else curves within 1e-9 of the range. If they can't be read, the face is
//   taken as untrimmed, and a warning names it. INTERNAL and EXTERNAL edges trim nothing.
// - Curves that leave the surface by less than the tolerances of their face follow its side there.
// - A face that the file reverses has u and v swapped, so that normals of solids point outwards.
// - `placement` is the face's place in the assembly, with the scales and mirrors of STEP's mapped items; `name` is the
//   product's (STEP), the entity's (IGES) or empty (BREP).
// - `colour` is that of the face, or else of the shell, solid or part that holds it, in STEP and IGES. An
//   instance of STEP with colours of its own has a shape of its own. Styles of other contexts are left out, with a
//   warning.
// - Texts are UTF-8. A file in GBK or Latin-1 is told by its bytes, with a warning.
// - A face that can't be read is left out, and a warning says why: degrees above max_degree, an unbounded plane, input
//   that its reader rejects (such as weights that are not positive).
// - Shapes of STEP that are not read, such as tessellations and CSG, are counted by kind: in a warning, or in the error
//   if the file holds nothing else.
//
// Shapes: each part that stands at several places is read once and has an instance for each place. A part is as much of
// the file as stands together at each of its places: a product of STEP that is no assembly; in other files, all that no
// part of it repeats.
//
// - Edges and vertices are shared where the file's faces share them; faces of IGES's trimmed surfaces share none. An
//   edge's curve is exact as surfaces are, and its loops' curves run at the same parameter, or at the one that
//   Coedge::parameter states exactly.
// - A face that is no less than its rectangle names its edges in `outline`, others in `trims`.
// - Tolerances are the file's, and no bounds: see edge_gaps() of topology.h.
// - `unit` is "mm" for STEP and IGES, and empty for BREP; `file_unit` is the file's word for its unit.
//
// Process: OpenCASCADE may crash on damaged files and keeps global state, so each call that needs it runs the program
// as a child process, with bounds on memory (512 MiB plus 256 times the file) and on computing time (120 seconds plus
// one for every 20 kB). Its damage ends with it, it ends with this process, and calls from any number of threads are
// independent. Packed files and bytes in memory are handed to it as a file in memory.

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "tessera/model.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// Formats of read_cad().
enum class CadFormat {
  by_extension,  ///< .step, .stp, .p21, .stpz, .iges, .igs, .brep, .brp in any case of letters, and these with .gz
  step,          ///< AP203, AP214 or AP242 (ISO 10303-21)
  iges,          ///< IGES 5.x in its fixed form, columns of 80 characters
  brep,          ///< OpenCASCADE's own format, as text or binary
};

/// Who reads STEP files. IGES and BREP files are always read by OpenCASCADE.
enum class StepReader {
  tessera,      ///< the library itself
  opencascade,  ///< the program tessera-cad-reader
  /// The library. If it fails or warns, the program reads the whole file, too. Its model is the result if the library
  /// failed, or if it has more faces, or as many and fewer warnings. Without a program, or if that fails: the library's
  /// model or error.
  either,
};

/// Options of read_cad() and parse_cad().
struct CadOptions {
  CadFormat format = CadFormat::by_extension;  ///< of the file, whatever its extension, unless by_extension
  /// The program that reads. If empty: the file that the environment variable TESSERA_CAD_READER names, or else the
  /// first tessera-cad-reader beside this program or library, in their ../libexec/tessera, in that of the installation,
  /// or on PATH.
  std::filesystem::path reader = {};
  const std::atomic<bool>* cancel = nullptr;     ///< polled; the call then ends the program and returns cancelled
  StepReader step_reader = StepReader::tessera;  ///< who reads STEP; no matter for other formats
  /// Called as Execution::progress, while the library reads a STEP file itself; never for other files.
  std::function<void(double)> progress = {};
};

/// Reads a CAD file.
///
/// Errors: the first warning's reason (no face is left), io_error (the file; the program cannot be started),
/// parse_error (the reason is the reader's; a packed file is damaged), invalid_weight (IGES: OpenCASCADE would read
/// another surface), unsupported (the extension; not a regular file; there is no program, or one of another version; a
/// model that another version kept; a packed file beyond the limits, an archive of several files, or a build without
/// zlib), out_of_memory, cancelled, internal (OpenCASCADE crashed; the program sent something else than a model).
///
/// Threads: any. Signals and other children of the process are left alone.
Result<Model> read_cad(const std::filesystem::path& path, const CadOptions& options = {});
/// Reads the bytes of a CAD file, which may be packed. `name` stands for the file in messages, and its extension states
/// the format if the options leave it open. Errors: as read_cad(), and io_error (no file in memory can be made for the
/// program). Threads: any.
Result<Model> parse_cad(std::string_view bytes, const std::filesystem::path& name, const CadOptions& options = {});
/// Returns a model of read_cad() as bytes that read_cad() and parse_cad() take in place of a CAD file, under its name.
/// They need no program for it, nor the time that the file takes: for browsers, and for files that are opened often.
/// The bytes are for programs of the same version. Errors: unsupported (a surface that is no B-spline; index = the
/// surface), out_of_memory. Threads: any.
Result<std::string> cad_model_bytes(const Model& model);
/// Returns the program that read_cad() starts with these options; one that is named need not exist. Errors: unsupported
/// (none is named or found). Threads: any.
Result<std::filesystem::path> find_cad_reader(const CadOptions& options = {});
/// Whether read_cad() knows the extension, also before .gz.
bool is_cad_file(const std::filesystem::path& path);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
