// tessera view: what its server answers, to whom, and how it ends.

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <memory>
#include <thread>

#include "io/file/descriptor.h"
#include "tools/run_in_terminal.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

/// A connection to a port of this machine.
class Connection {
 public:
  explicit Connection(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  void send(const std::string& bytes) const {
    EXPECT_EQ(::send(socket_.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
  }
  /// All that comes until the server closes.
  std::string receive() const {
    std::string all;
    std::array<char, 65536> buffer{};
    for (ssize_t got = 0; (got = ::recv(socket_.number(), buffer.data(), buffer.size(), 0)) > 0;)
      all.append(buffer.data(), static_cast<std::size_t>(got));
    return all;
  }

 private:
  Descriptor socket_;
};

class View : public ToolTest {
 protected:
  View() {
    std::filesystem::create_directories(folder_ / "web/src");
    folder_.file("web/index.html", page_);
    folder_.file("web/src/a.js", "let a;");
    folder_.file("web/src/a.mjs", "let b;");
    folder_.file("web/style.css", "p {}");
    folder_.file("web/icon.svg", "<svg/>");
    folder_.file("web/data.json", "{}");
    folder_.file("web/tessera.wasm", std::string("\0asm", 4));
    folder_.file("web/.hidden", "h");
    folder_.file("secret.txt", "secret");
    std::filesystem::create_symlink("../secret.txt", folder_ / "web/link.txt");
    std::filesystem::create_directory_symlink("..", folder_ / "web/up");
  }

  /// Starts the command; its output goes to files. Returns the line that it prints.
  std::string start(Names words, const std::vector<std::string>& variables = {}) {
    std::filesystem::remove(folder_ / "said");
    words.insert(words.begin(), {"sh", "-c", "exec \"$@\" >said 2>faults", "sh", program_, "view"});
    tool_ = std::make_unique<RunningProgram>(folder_, words, variables);
    for (int k = 0; k < 2000; ++k) {
      std::this_thread::sleep_for(10ms);
      if (!std::filesystem::exists(folder_ / "said")) continue;
      const std::string said = content_of(folder_ / "said");
      if (said.ends_with('\n')) return said.substr(0, said.size() - 1);
    }
    ADD_FAILURE() << "nothing is said: " << content_of(folder_ / "faults");
    return "";
  }
  /// The text on standard error, once there is some.
  std::string fault() const {
    for (int k = 0; k < 2000 && content_of(folder_ / "faults").empty(); ++k) std::this_thread::sleep_for(10ms);
    return content_of(folder_ / "faults");
  }
  void serve(const Names& words) {
    address_ = start(words);
    const std::size_t begin = address_.find(":", 5) + 1;
    port_ = std::stoi(address_.substr(begin));
    host_ = "127.0.0.1:" + std::to_string(port_);
  }
  int interrupt() {
    tool_->signal(SIGINT);
    return tool_->wait().status;
  }

  std::string raw(const std::string& bytes) const {
    const Connection connection(port_);
    connection.send(bytes);
    return connection.receive();
  }
  std::string ask(const std::string& path, const std::string& method = "GET") const {
    return raw(method + " " + path + " HTTP/1.1\r\nHost: " + host_ + "\r\n\r\n");
  }
  static int status_of(const std::string& response) { return std::stoi(response.substr(9)); }
  static std::string body_of(const std::string& response) { return response.substr(response.find("\r\n\r\n") + 4); }

  const std::string page_ = "<!doctype html><title>fake</title>";
  std::string program_ = TESSERA_TOOL, address_, host_;
  int port_ = 0;
  std::unique_ptr<RunningProgram> tool_;
};

TEST_F(View, ServesThePageAndTheModelUntilItIsInterrupted) {
  for (const int signal : {SIGINT, SIGTERM}) {
    serve({teapot, "--web", "web", "--no-browser"});
    EXPECT_EQ(address_, "http://" + host_ + "/?model=/model/teapot.bpt");
    EXPECT_EQ(body_of(ask("/")), page_);
    EXPECT_EQ(body_of(ask("/?model=/model/teapot.bpt")), page_);
    EXPECT_EQ(body_of(ask("/model/teapot.bpt")), content_of(teapot));
    const Connection idle(port_);  // occupies a worker
    tool_->signal(signal);
    EXPECT_EQ(tool_->wait().status, 128 + signal);
    EXPECT_EQ(content_of(folder_ / "faults"), "");
  }
}

TEST_F(View, HeadersSaveThePage) {
  serve({teapot, "--web", "web", "--no-browser"});
  const std::vector<std::pair<std::string, std::string>> types{{"/", "text/html; charset=utf-8"},
                                                               {"/index.html", "text/html; charset=utf-8"},
                                                               {"/src/a.js", "text/javascript; charset=utf-8"},
                                                               {"/src/a.mjs", "text/javascript; charset=utf-8"},
                                                               {"/style.css", "text/css; charset=utf-8"},
                                                               {"/icon.svg", "image/svg+xml"},
                                                               {"/data.json", "application/json"},
                                                               {"/tessera.wasm", "application/wasm"},
                                                               {"/model/teapot.bpt", "application/octet-stream"}};
  for (const auto& [path, type] : types) {
    const std::string response = ask(path), head = response.substr(0, response.find("\r\n\r\n") + 2);
    EXPECT_EQ(status_of(response), 200) << path;
    EXPECT_THAT(head, HasSubstr("\r\nContent-Type: " + type + "\r\n"));
    EXPECT_THAT(head, HasSubstr("\r\nContent-Length: " + std::to_string(body_of(response).size()) + "\r\n"));
    for (const char* const line :
         {"Connection: close", "Cache-Control: no-store", "X-Content-Type-Options: nosniff",
          "Cross-Origin-Opener-Policy: same-origin", "Cross-Origin-Embedder-Policy: require-corp",
          "Cross-Origin-Resource-Policy: same-origin",
          "Content-Security-Policy: default-src 'none'; script-src 'self' "})
      EXPECT_THAT(head, HasSubstr(std::string("\r\n") + line)) << path;
    const std::string without = ask(path, "HEAD");
    EXPECT_EQ(without, response.substr(0, response.size() - body_of(response).size())) << path;
  }
}

TEST_F(View, ScriptsWithinThePageAreMarked) {
  folder_.file("web/index.html", "<script type=\"importmap\">{}</script><p><script src=\"a.js\"></script>");
  std::string nonces[2];
  for (std::string& nonce : nonces) {
    serve({teapot, "--web", "web", "--no-browser"});
    const std::string response = ask("/");
    const std::size_t at = response.find("; script-src 'self' 'wasm-unsafe-eval' 'nonce-") + 46;
    nonce = response.substr(at, response.find('\'', at) - at);
    EXPECT_EQ(nonce.size(), 32u) << response;
    EXPECT_EQ(body_of(response), "<script nonce=\"" + nonce + "\" type=\"importmap\">{}</script><p><script nonce=\"" +
                                     nonce + "\" src=\"a.js\"></script>");
  }
  EXPECT_NE(nonces[0], nonces[1]);
}

TEST_F(View, NothingOutsideTheFolderIsServed) {
  serve({teapot, "--web", "web", "--no-browser"});
  for (const char* const path :
       {"/missing", "/src", "/src/", "/link.txt", "/up/secret.txt", "/../secret.txt", "/src/../../secret.txt",
        "/%2e%2e/secret.txt", "/src/..%2f..%2fsecret.txt", "/.hidden", "//index.html", "/src//a.js", "/./index.html",
        "/index.html/", "/model/", "/model/other.bpt", "/model/../secret.txt", "/model/teapot.bpt/", "/model"}) {
    const std::string response = ask(path);
    EXPECT_EQ(status_of(response), 404) << path;
    EXPECT_THAT(response, testing::Not(HasSubstr("secret"))) << path;
  }
}

TEST_F(View, OtherHostsAndMethodsAreRefused) {
  serve({teapot, "--web", "web", "--no-browser"});
  const std::string port = ":" + std::to_string(port_);
  const auto of_host = [&](const std::string& lines) { return status_of(raw("GET / HTTP/1.1\r\n" + lines + "\r\n")); };
  EXPECT_EQ(of_host("hOST:\t localhost" + port + " \r\nAccept: */*\r\n"), 200);
  for (const std::string& host : {std::string("evil.example"), "evil.example" + port, std::string("127.0.0.1"),
                                  std::string("127.0.0.1:1"), "127.0.0.1.evil.example" + port, std::string()})
    EXPECT_EQ(of_host("Host: " + host + "\r\n"), 403) << host;
  EXPECT_EQ(of_host("Accept: */*\r\n"), 400);
  EXPECT_EQ(of_host("Host: " + host_ + "\r\nHost: " + host_ + "\r\n"), 400);
  EXPECT_EQ(of_host("Host: " + host_ + "\r\nno colon\r\n"), 400);
  for (const char* const method : {"POST", "PUT", "DELETE", "OPTIONS", "get"}) {
    const std::string response = ask("/", method);
    EXPECT_EQ(status_of(response), 405) << method;
    EXPECT_THAT(response, HasSubstr("\r\nAllow: GET, HEAD\r\n"));
  }
  const std::string rest = "\r\nHost: " + host_ + "\r\n\r\n";
  for (const char* const line : {"", "GET", "GET /", "GET / FTP/1.1", "GET  / HTTP/1.1", "GET index.html HTTP/1.1",
                                 "GET http://x/ HTTP/1.1", "GET /%zz HTTP/1.1", "GET /%4 HTTP/1.1", "GET /%00 HTTP/1.1",
                                 "GET /%-1 HTTP/1.1", "G(T / HTTP/1.1", "GET /\x01 HTTP/1.1"})
    EXPECT_EQ(status_of(raw(line + rest)), 400) << line;
  EXPECT_EQ(status_of(raw("GET / HTTP/2.0" + rest)), 505);
  EXPECT_EQ(status_of(raw("GET /" + std::string(20000, 'a'))), 431);
  EXPECT_EQ(body_of(ask("/")), page_);
}

TEST_F(View, WhoSaysNothingIsNotWaitedForLong) {
  serve({teapot, "--web", "web", "--no-browser"});
  std::vector<std::unique_ptr<Connection>> silent;
  for (int k = 0; k < 20; ++k) silent.push_back(std::make_unique<Connection>(port_));  // more than there are workers
  silent[0]->send("GET / HT");
  EXPECT_EQ(body_of(ask("/")), page_);  // once one has been closed
  EXPECT_EQ(status_of(silent[0]->receive()), 408);
  EXPECT_EQ(silent[1]->receive(), "");
}

TEST_F(View, NamesAreEncodedForThePageAndForTheServer) {
  const std::string name = "a b#50%\xC3\xA9?&.bpt";
  folder_.file(name, content_of(teapot));
  serve({name, "--web", "web", "--no-browser"});
  EXPECT_THAT(address_, testing::EndsWith("/?model=/model/a%2520b%252350%2525%25C3%25A9%253F%2526.bpt"));
  EXPECT_EQ(body_of(ask("/model/a%20b%2350%25%C3%A9%3F%26.bpt")), content_of(teapot));
}

TEST_F(View, TheModelIsReadAtEachRequest) {
  folder_.file("part.bpt", "first");
  serve({"part.bpt", "--web", "web", "--no-browser"});
  EXPECT_EQ(body_of(ask("/model/part.bpt")), "first");
  const std::string large(std::size_t{5} << 20, 'x');
  folder_.file("part.bpt", large);
  EXPECT_EQ(body_of(ask("/model/part.bpt")), large);
  std::filesystem::remove(folder_ / "part.bpt");
  EXPECT_EQ(status_of(ask("/model/part.bpt")), 404);
}

TEST_F(View, OpensTheBrowserAndGoesOnWithoutOne) {
  folder_.file("xdg-open", "#!/bin/sh\nprintf %s \"$1\" >opened.tmp && mv opened.tmp opened; exit 3\n");
  std::filesystem::permissions(folder_ / "xdg-open", std::filesystem::perms::owner_all);
  const std::string path = "PATH=" + folder_.path().string() + ":/usr/bin:/bin";
  const std::string address = start({teapot, "--web", "web"}, {path});
  for (int k = 0; k < 1000 && !std::filesystem::exists(folder_ / "opened"); ++k) std::this_thread::sleep_for(10ms);
  EXPECT_EQ(content_of(folder_ / "opened"), address);
  EXPECT_EQ(fault(), "tessera: warning: no browser is opened: xdg-open ended with 3; open the address above\n");
  EXPECT_EQ(interrupt(), 128 + SIGINT);

  std::filesystem::create_directory(folder_ / "bin");
  for (const char* const program : {"sh", "env"})
    std::filesystem::create_symlink(std::string("/usr/bin/") + program, folder_.path() / "bin" / program);
  start({teapot, "--web", "web"}, {"PATH=" + (folder_ / "bin")});
  EXPECT_THAT(fault(), StartsWith("tessera: warning: no browser is opened: xdg-open cannot be started: "));
  EXPECT_EQ(interrupt(), 128 + SIGINT);
}

TEST_F(View, TerminalsAreToldHowItEnds) {
  if (!has_pseudo_terminals()) GTEST_SKIP() << "there are no pseudo-terminals";
  folder_.file("xdg-open", "#!/bin/sh\nkill -INT $PPID\n");
  std::filesystem::permissions(folder_ / "xdg-open", std::filesystem::perms::owner_all);
  TerminalKind kind;
  kind.variables.push_back("PATH=" + folder_.path().string() + ":/usr/bin:/bin");
  const TerminalRun run = run_in_terminal(folder_, {"view", teapot, "--web", "web"}, kind);
  EXPECT_EQ(run.status, 128 + SIGINT) << run.screen;
  EXPECT_THAT(run.screen,
              testing::MatchesRegex("http://127.0.0.1:[0-9]+/.model=/model/teapot.bpt\r\nserving until Ctrl-C\r\n"));
}

TEST_F(View, SaysWhatItServesAsJson) {
  const json facts = json::parse(start({teapot, "--web", "web", "--no-browser", "--json"}));
  const std::string page = content_of(TESSERA_SOURCE_DIR "/tools/tessera/JSON.md");
  const std::string section = page.substr(page.find("\n## view\n"));
  EXPECT_EQ(std::ranges::count(section, '\n'), 7 + static_cast<std::ptrdiff_t>(facts.size()));
  for (const auto& [key, value] : facts.items()) EXPECT_THAT(section, HasSubstr("\n| `" + key + "` | "));
  EXPECT_EQ(facts["model"], teapot);
  EXPECT_EQ(facts["shown"], "teapot.bpt");
  EXPECT_EQ(facts["web"], "web");
  EXPECT_EQ(facts["address"],
            "http://127.0.0.1:" + std::to_string(facts["port"].get<int>()) + "/?model=/model/teapot.bpt");
}

TEST_F(View, WrongCommandsAreErrors) {
  expect_failure({"view"}, 2, "view: expected MODEL, found none");
  expect_failure({"view", teapot, teapot}, 2, "view: the word " + teapot + " is not expected");
  expect_failure({"view", teapot, "--port", "65536"}, 2, "--port: expected a whole number from 0 to 65535");
  expect_failure({"view", "missing.step", "--web", "web"}, 1, "missing.step: cannot be opened: No such file");
  expect_failure({"view", "web", "--web", "web"}, 1, "web: expected a file");
  folder_.file("mesh.stl", "solid");
  expect_failure({"view", "mesh.stl", "--web", "web"}, 1, "mesh.stl: unsupported format \".stl\"");
  expect_failure({"view", teapot, "--web", "nowhere"}, 1, "nowhere has no file index.html; make it in");
  const ToolRun unknown = run({"view", teapot}, {"TESSERA_WEB=elsewhere"});
  EXPECT_EQ(unknown.status, 1);
  EXPECT_THAT(unknown.errors, HasSubstr("elsewhere has no file index.html"));
  EXPECT_THAT(unknown.errors, HasSubstr("cmake --preset wasm"));
  serve({teapot, "--web", "web", "--no-browser"});
  expect_failure({"view", teapot, "--web", "web", "--port", std::to_string(port_)}, 1,
                 host_ + " cannot be listened on: Address already in use");
}

TEST_F(View, ThePageIsFoundBesideTheInstalledProgram) {
  std::filesystem::create_directories(folder_ / "usr/bin");
  std::filesystem::create_directories(folder_ / "usr/share/tessera");
  program_ = folder_ / "usr/bin/tessera";
  std::filesystem::copy(TESSERA_TOOL, program_);
  const ToolRun without = run_program(folder_, {program_, "view", teapot, "--no-browser"}, {"TESSERA_WEB="});
  EXPECT_EQ(without.status, 1);
  EXPECT_THAT(without.errors, HasSubstr("neither " + (folder_ / "usr/share/tessera/web") + " nor "));
  std::filesystem::rename(folder_ / "web", folder_ / "usr/share/tessera/web");
  EXPECT_THAT(start({teapot, "--no-browser"}, {"TESSERA_WEB="}), StartsWith("http://127.0.0.1:"));
}

#ifdef TESSERA_HAS_CAD_READER
TEST_F(View, FilesOfOpenCascadeAreReadOnce) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const std::string file = (std::filesystem::path(data) / "brep_occt/bottle.brep").string();
  serve({file, "--web", "web", "--no-browser"});
  EXPECT_THAT(address_, testing::EndsWith("/?model=/model/bottle.brep"));
  folder_.file("bottle.brep", body_of(ask("/model/bottle.brep")));
  const ToolRun kept = run({"info", "bottle.brep"}, {"TESSERA_CAD_READER=/nowhere"});
  const auto after_size = [](const std::string& text) { return text.substr(text.find("\n")); };
  EXPECT_EQ(after_size(kept.output), after_size(output_of({"info", file}))) << kept.errors;
  EXPECT_THAT(kept.output, HasSubstr("edges"));
  EXPECT_THAT(fault(), HasSubstr("read once, by OpenCASCADE"));
}
#endif

}}  // namespace tessera::test
