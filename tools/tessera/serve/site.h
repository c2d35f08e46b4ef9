#pragma once
// The content of the server of `tessera view`: the files of the page, and one model.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/file/descriptor.h"
#include "serve/http.h"
#include "tessera/status.h"

namespace tessera::cli {

/// The model that the page shows: a file, or the bytes that it was converted to.
struct ServedModel {
  std::string name;            ///< the file's name without folders, from which the page tells the format
  std::filesystem::path file;  ///< opened at each request, unless there are bytes
  std::shared_ptr<const std::string> bytes{};  ///< else null
};

class Site {
 public:
  /// `folder` holds the page. Errors: io_error (it cannot be opened, or has no index.html).
  static Result<Site> make(const std::filesystem::path& folder, ServedModel model);

  /// The path of the model, with a query for the page: "/?model=/model/part.step".
  std::string address() const;
  /// Answers a GET. Files of the page are opened below its folder, and links there are not followed. Threads: any.
  HttpResponse respond(const HttpRequest& request) const;

 private:
  Site(Descriptor folder, ServedModel model, std::string nonce);
  HttpResponse model_response() const;
  HttpResponse page_response(const std::string& name) const;

  Descriptor folder_;
  ServedModel model_;
  std::string nonce_;  ///< marks the scripts within pages, so that no others run
};

/// The folders in which the page is looked for: beside this program as it is installed, and where it is built.
std::vector<std::filesystem::path> usual_web_folders();

/// The folder of the page: `named`, or else that of the environment variable TESSERA_WEB, or else the first of the
/// usual ones that has the page. Errors: io_error (it is not there; the message says how to make it).
Result<std::filesystem::path> find_web_folder(const std::string& named);

}  // namespace tessera::cli
