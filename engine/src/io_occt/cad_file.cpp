#include "io_occt/cad_file.h"

#include <opencascade/Interface_Check.hxx>
#include <opencascade/Interface_CheckIterator.hxx>
#include <opencascade/Interface_Static.hxx>
#include <opencascade/Message.hxx>
#include <opencascade/Message_Messenger.hxx>
#include <opencascade/Message_Printer.hxx>
#include <opencascade/TCollection_HAsciiString.hxx>
#include <opencascade/TransferBRep.hxx>
#include <opencascade/Transfer_Binder.hxx>
#include <opencascade/Transfer_TransientProcess.hxx>
#include <opencascade/XSControl_TransferReader.hxx>
#include <opencascade/XSControl_WorkSession.hxx>

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

/// A message such as "**** ERR StepFile : Undefined Parsing: Line 109: Incorrect syntax    ****" without its frame.
std::string plain(std::string text) {
  for (const char* const prefix : {"ERR StepFile : ", "Undefined Parsing: "}) {
    const std::size_t place = text.find(prefix);
    if (place != std::string::npos) text.erase(0, place + std::char_traits<char>::length(prefix));
  }
  const std::size_t first = text.find_first_not_of(" *\n"), last = text.find_last_not_of(" *\n");
  return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

class LastFailure : public Message_Printer {
 public:
  explicit LastFailure(std::string& text) : text_(text) {}

 private:
  void send(const TCollection_AsciiString& message, const Message_Gravity gravity) const override {
    if (gravity >= Message_Alarm) text_ = plain(message.ToCString());
  }
  std::string& text_;
};

void collect_complaints(const Interface_InterfaceModel& model, const Interface_CheckIterator& checks,
                        DescribedShape& file) {
  for (checks.Start(); checks.More(); checks.Next()) {
    const handle<Interface_Check>& check = checks.Value();
    const std::string label = label_of(model, check->Entity());
    for (int k = 1; k <= check->NbFails(); ++k) {
      const std::string message = (label.empty() ? "" : label + ": ") + plain(check->CFail(k));
      if (std::find(file.complaints.begin(), file.complaints.end(), message) == file.complaints.end())
        file.complaints.push_back(message);
    }
  }
}

}  // namespace

std::string label_of(const Interface_InterfaceModel& model, const handle<Standard_Transient>& entity) {
  if (entity.IsNull() || model.Number(entity) == 0) return {};
  const handle<TCollection_HAsciiString> label = model.StringLabel(entity);
  return label.IsNull() ? std::string() : std::string(label->ToCString());
}

void take_messages(std::string& last_failure) {
  Message_SequenceOfPrinters& printers = Message::DefaultMessenger()->ChangePrinters();
  printers.Clear();
  printers.Append(new LastFailure(last_failure));
}

void set_unit() { Interface_Static::SetCVal("xstep.cascade.unit", "MM"); }

Colour colour_of(const Quantity_Color& colour, double alpha) {
  double red = 0, green = 0, blue = 0;
  colour.Values(red, green, blue, Quantity_TOC_sRGB);
  const auto part = [](double value) { return value > 0 ? static_cast<float>(std::min(value, 1.0)) : 0.0F; };
  return {part(red), part(green), part(blue), part(alpha)};
}

DescribedShape transferred(const XSControl_Reader& reader) {
  DescribedShape file;
  file.shape = reader.OneShape();
  file.unit = "mm";
  const handle<Interface_InterfaceModel> model = reader.Model();
  const handle<Transfer_TransientProcess>& process = reader.WS()->TransferReader()->TransientProcess();
  for (int k = 1; k <= process->NbMapped(); ++k) {
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process->MapItem(k));
    if (shape.IsNull() || shape.ShapeType() != TopAbs_FACE) continue;
    file.labels[identity(shape)] = label_of(*model, process->Mapped(k));
  }
  collect_complaints(*model, process->CheckList(true), file);
  return file;
}

}}  // namespace tessera::abi_0_1
