#pragma once
// A file as OpenCASCADE reads it.

#include <opencascade/Interface_InterfaceModel.hxx>
#include <opencascade/Quantity_Color.hxx>
#include <opencascade/XSControl_Reader.hxx>
#include <string>

#include "occt/described_shape.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

// Loads a file. Messages begin with `path`. Changes OpenCASCADE's settings and diverts its messages. Errors:
// parse_error, io_error. May throw Standard_Failure.
Result<DescribedShape> load_step(const std::string& path);
Result<DescribedShape> load_iges(const std::string& path);
Result<DescribedShape> load_brep(const std::string& path);

// Shared by the loaders.

/// Diverts OpenCASCADE's messages from standard output; `last_failure` keeps the last that reports a failure.
void take_messages(std::string& last_failure);
/// Sets millimetres. Call it after making the reader, which defines the settings.
void set_unit();
/// The shape, the labels and the complaints of what the reader has transferred.
DescribedShape transferred(const XSControl_Reader& reader);
/// The label of an entity, such as "#51" or "D113"; empty if the model does not hold it.
std::string label_of(const Interface_InterfaceModel& model, const opencascade::handle<Standard_Transient>& entity);
/// A colour of OpenCASCADE's, which are linear, in sRGB.
Colour colour_of(const Quantity_Color& colour, double alpha);
}}  // namespace tessera::abi_0_1
