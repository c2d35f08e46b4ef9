// tessera view: the page that shows a model in a browser, on the loopback address.

#include <sys/stat.h>

#include <memory>
#include <optional>

#include "commands/commands.h"
#include "console/terminal.h"
#include "io/format/output_formats.h"
#include "line/arguments.h"
#include "serve/browser.h"
#include "serve/server.h"
#include "serve/site.h"
#include "stages/load.h"
#include "tessera/cad.h"
#include "tessera/io.h"

namespace tessera::cli {
namespace {

namespace fs = std::filesystem;

struct ViewOptions {
  std::string file;
  std::string web;  ///< folder of the page; empty: it is looked for
  int port = 0;     ///< 0: a free one
  bool no_browser = false;
};

/// The extension before .gz, in small letters.
std::string inner_extension(const std::string& file) {
  const fs::path path(file);
  return lower_extension(path) == ".gz" ? lower_extension(path.stem()) : lower_extension(path);
}

bool is_in(const std::string& extension, const std::string& formats) {
  return !extension.empty() && (formats + ",").find(extension + ",") != std::string::npos;
}

/// Whether OpenCASCADE alone reads the file, which browsers do not have.
bool must_be_read_here(const std::string& file) { return is_in(inner_extension(file), ".iges, .igs, .brep, .brp"); }

/// Checks that the page can read a file.
Status check_file(const std::string& file) {
  struct stat facts {};
  if (::stat(file.c_str(), &facts) != 0)
    return Status(StatusCode::io_error, file + ": cannot be opened: " + std::system_category().message(errno));
  if (!S_ISREG(facts.st_mode)) return Status(StatusCode::unsupported, file + ": expected a file");
  if (::access(file.c_str(), R_OK) != 0)
    return Status(StatusCode::io_error, file + ": cannot be opened: " + std::system_category().message(errno));
  const std::string extension = inner_extension(file);
  if (is_in(extension, model_formats())) return {};
  return Status(StatusCode::unsupported,
                file + ": unsupported format \"" + extension + "\": surfaces are read as " + model_formats());
}

/// Reads a file here, and keeps its model as bytes, which the page reads in its place.
Result<ServedModel> read_here(const Job& job, std::string name, Timings& timings) {
  const Result<Loaded> loaded = load(job, {}, With::surfaces, timings);
  if (!loaded) return loaded.status();
  Result<std::string> bytes = cad_model_bytes(loaded->model);
  if (!bytes) return bytes.status();
  warn(job.inputs[0] + ": read once, by OpenCASCADE; the page shows this model until the program ends");
  return ServedModel{std::move(name), {}, std::make_shared<const std::string>(*std::move(bytes))};
}

Result<ServedModel> served_model(const Job& job, Timings& timings) {
  const std::string& file = job.inputs[0];
  if (Status status = check_file(file); !status.ok()) return status;
  std::string name = fs::path(file).filename().string();
  if (must_be_read_here(file)) return read_here(job, std::move(name), timings);
  return ServedModel{std::move(name), fs::absolute(file)};
}

Status run_view(const Job& job, const ViewOptions& options, const CommonOptions& common, Timings& timings) {
  const Result<fs::path> web = find_web_folder(options.web);
  if (!web) return web.status();
  Result<ServedModel> model = served_model(job, timings);
  if (!model) return model.status();
  const std::string shown = model->name;
  const Result<Site> site = Site::make(*web, *std::move(model));
  if (!site) return site.status();
  const Result<LoopbackServer> server = LoopbackServer::listen(options.port);
  if (!server) return server.status();

  const std::string address = "http://127.0.0.1:" + std::to_string(server->port()) + site->address();
  Report report;
  report.add("model", job.inputs[0]);
  report.add("shown", shown);
  report.add("web", web->string());
  report.add("port", server->port());
  report.add("address", address, address + (output_is_terminal() ? "\nserving until Ctrl-C" : ""));
  if (Status status = report.print({}, common, timings); !status.ok()) return status;
  std::optional<BrowserStart> browser;
  if (!options.no_browser) browser.emplace(address);
  const auto look_after = [&] {
    const std::string fault = browser ? browser->take_fault() : std::string();
    if (!fault.empty()) warn("no browser is opened: " + fault + "; open the address above");
  };
  return server->run([&](const HttpRequest& request) { return site->respond(request); }, interrupted(), look_after);
}

constexpr const char* view_footer =
    R"(Prints the page's address, opens it in the browser, and serves until Ctrl-C. The browser does all the work: the
page is Tessera as WebAssembly, and needs no network. Reloading it reads the file again. One model at a time.
IGES and BREP files, which browsers cannot read, are read here, once.
The page's folder is looked for beside the installed program (share/tessera/web) and in the build (build/wasm/web),
unless --web or the environment variable TESSERA_WEB names it. Only programs on this machine can connect.

Examples:
  tessera view part.step
  tessera view part.step --no-browser --port 8080)";

}  // namespace

void add_view(Command& tool, Session& session) {
  Command& command = tool.add_command("view", "Show a model in the browser");
  const auto options = std::make_shared<ViewOptions>();
  command.add_text("MODEL", "FILE", "The file with surfaces (" + model_formats() + ")", options->file)
      .require()
      .check(fault_of_name);
  command.add_flag("--no-browser", "Print the address and open no browser", options->no_browser);
  command.add_count("--port", "N", "Port of 127.0.0.1 to listen on [a free one]", 0, 65535,
                    [options](std::size_t port) { options->port = static_cast<int>(port); });
  command.add_text("--web", "FOLDER", "Folder of the page [the installed or built one]", options->web)
      .check(fault_of_name);
  add_common(command, session.common);
  command.footer = view_footer;
  command.choose = [options, &session] {
    Plan plan;
    plan.jobs.push_back({{options->file}, ""});
    session.choose(plan, options, run_view);
  };
}

}  // namespace tessera::cli
