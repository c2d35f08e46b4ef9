#include "io/cad/cad_reader.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>

#include "base/text.h"
#include "io/cad/child_process.h"
#include "io/cad/kept_model.h"
#include "io/cad/model_bytes.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using namespace std::chrono_literals;
constexpr auto last_words = 2s;    // for the rest of a message that is no greeting
constexpr auto end_of_child = 2s;  // after its last byte

/// One conversation with a reader.
class Conversation {
 public:
  Conversation(ChildProcess child, const CadReaderRun& run) : child_(std::move(child)), run_(run) {}

  Result<Model> model() {
    std::string bytes;
    if (Status status = greet(); !status.ok()) return status;
    if (Status status = receive(bytes); !status.ok()) return status;
    Result<Model> model = model_from_bytes(bytes);
    child_.collect(end_of_child);
    if (model || !model.status().message().starts_with(damaged_model)) return model;
    return Status(StatusCode::internal, who() + "sent " + model.status().message());
  }

 private:
  std::string who() const { return "the CAD reader " + run_.reader + " "; }
  static Status cancelled() { return Status(StatusCode::cancelled, "the reading was cancelled"); }

  Status greet() {
    std::string greeting;
    const Reading end = child_.read(greeting, greeting_size, {run_.startup, run_.cancel});
    if (end == Reading::cancelled) return cancelled();
    if (greeting == cad_reader_greeting()) return {};
    const std::string wanted = quoted_words(cad_reader_greeting());
    if (greeting.starts_with(greeting_begin) && greeting.size() == greeting_size)
      return Status(StatusCode::unsupported, who() + "is " + quoted_words(greeting) + ", it must be " + wanted +
                                                 ": install both from one build, or name another reader by "
                                                 "TESSERA_CAD_READER");
    if (end == Reading::late)
      return Status(StatusCode::internal, who() + "did not say " + wanted + " within " +
                                              std::to_string(run_.startup.count()) + " milliseconds");
    return no_greeting(greeting);
  }

  Status no_greeting(std::string& words) {
    constexpr std::size_t enough = 400;
    child_.read(words, enough, {last_words, run_.cancel});
    if (words.empty()) return ended("a greeting");
    return Status(StatusCode::internal, who() + "printed " + quoted_words(words.substr(0, words.find('\n'))) +
                                            ", it must begin with " + quoted_words(cad_reader_greeting()));
  }

  Status receive(std::string& bytes) {
    std::string head;
    std::uint64_t size = 0;
    Reading end = child_.read(head, sizeof size, {{}, run_.cancel});
    if (end == Reading::whole) {
      std::memcpy(&size, head.data(), sizeof size);
      if (size > limits_.memory_bytes)
        return Status(StatusCode::internal,
                      who() + "announced " + counted(size, "byte") + ", more than the memory that it may use");
      end = child_.read(bytes, size, {{}, run_.cancel});
    }
    if (end == Reading::cancelled) return cancelled();
    if (end == Reading::whole) return {};
    return ended(head.size() < sizeof size
                     ? "a model"
                     : std::to_string(size - bytes.size()) + " of " + counted(size, "byte") + " of the model");
  }

  /// Why the child ended without what it owed.
  Status ended(const std::string& owed) {
    const std::optional<int> end = child_.collect(end_of_child);
    if (run_.cancel && run_.cancel->load()) return cancelled();  // Ctrl-C ends the child, too
    if (!end) return Status(StatusCode::internal, who() + "ended without " + owed);
    if (WIFEXITED(*end) && WEXITSTATUS(*end) == cad_reader_out_of_memory)
      return Status(StatusCode::out_of_memory, "OpenCASCADE exceeded its memory limit");
    if (WIFEXITED(*end))
      return Status(StatusCode::internal,
                    who() + "ended without " + owed + " (exit status " + std::to_string(WEXITSTATUS(*end)) + ")");
    if (WTERMSIG(*end) == SIGXCPU)
      return Status(StatusCode::internal,
                    "OpenCASCADE did not end within " + counted(limits_.cpu_seconds, "second") + " of processor time");
    const char* const signal = ::sigdescr_np(WTERMSIG(*end));
    return Status(StatusCode::internal,
                  "OpenCASCADE crashed (" + std::string(signal ? signal : "unknown signal") + ")");
  }

  ChildProcess child_;
  const CadReaderRun& run_;
  const CadReaderLimits limits_ = cad_reader_limits(run_.file_bytes);
};

}  // namespace

Result<Model> run_cad_reader(const CadReaderRun& run) {
  const std::string process = std::to_string(::getpid());
  const std::string& name = run.name.empty() ? run.file : run.name;
  Result<ChildProcess> child = ChildProcess::start({run.reader, std::string(run.format), run.file, process});
  if (!child)
    return Status(child.status().code(), name + ": the CAD reader " + run.reader + " " + child.status().message());
  Result<Model> model = Conversation(*std::move(child), run).model();
  if (model) {
    for (std::string& warning : model->warnings)
      if (warning.starts_with(run.file)) warning.replace(0, run.file.size(), name);
    return model;
  }
  const std::string& message = model.status().message();
  const std::string words = message.starts_with(run.file) ? message.substr(run.file.size()) : ": " + message;
  return Status(model.status().code(), name + words, model.status().index());
}

}}  // namespace tessera::abi_0_1
