// tessera man: the manual page.

#include <unistd.h>

#include <cstdio>
#include <memory>
#include <sstream>
#include <string>

#include "commands/commands.h"
#include "line/arguments.h"
#include "line/command_line.h"
#include "tessera/version.h"

namespace tessera::cli {
namespace {

/// Text for roff: no control lines, no escapes, hyphens that can be copied as minus signs.
std::string roff(const std::string& text) {
  std::string out = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

/// "\fB\-o\fR, \fB\-\-output\fR \fIFILE\fR".
std::string names_of(const Option& option) {
  std::string text;
  for (const std::string& name : option.names) {
    text += text.empty() ? "" : ", ";
    text += (option.is_positional() ? "\\fI" : "\\fB") + roff(name) + "\\fR";
  }
  if (option.repeated) text += " ...";
  if (!option.is_positional() && !option.value.empty()) text += " \\fI" + roff(option.value) + "\\fR";
  return text;
}

std::string option_entry(const Option& option) {
  std::string text = ".TP\n" + names_of(option) + "\n" + roff(option.full_text());
  if (option.required) text += " (required)";
  return text + "\n";
}

/// Paragraphs are filled; text after "Examples:" keeps its lines.
std::string footer_text(const std::string& footer) {
  std::istringstream lines(footer);
  std::string text = ".PP\n";
  bool examples = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("Example")) {
      examples = true;
      text += roff(line) + "\n.PP\n.RS 4\n.nf\n";
    } else if (line.empty()) {
      text += ".PP\n";
    } else {
      text += roff(line.substr(line.find_first_not_of(' '))) + "\n";
    }
  }
  return text + (examples ? ".fi\n.RE\n" : "");
}

std::string synopsis(const Command& tool) {
  std::string text;
  for (const Command& command : tool.commands) {
    std::string words;
    for (const Option& option : command.options)
      if (option.is_positional()) words += " \\fI" + roff(option.names[0]) + "\\fR" + (option.repeated ? " ..." : "");
    text +=
        (text.empty() ? "" : ".br\n") + std::string("\\fBtessera ") + command.name + "\\fR" + words + " [options]\n";
  }
  return text;
}

std::string command_section(const Command& command) {
  std::string text = ".SS \"tessera " + command.name + "\"\n" + roff(command.text) + ".\n";
  for (const Option& option : command.options) text += option_entry(option);
  return text + footer_text(command.footer);
}

std::string man_page(const Command& tool, const std::string& version) {
  std::string text = ".TH TESSERA 1 \"\" \"tessera " + roff(version) + "\" \"User Commands\"\n";
  text += ".SH NAME\ntessera \\- turns parametric surfaces into points, meshes, pictures and ray hits\n";
  text += ".SH SYNOPSIS\n" + synopsis(tool);
  text += ".SH DESCRIPTION\n" + footer_text(tool.footer);
  text += ".SH OPTIONS\n";
  for (const Option& option : tool.options) text += option_entry(option);
  text += ".SH COMMANDS\n";
  for (const Command& command : tool.commands) text += command_section(command);
  return text;
}

/// Opens the page in man's viewer. Returns whether there is one.
bool show(const std::string& page) {
  std::FILE* const viewer = popen("command -v man > /dev/null && exec man -l -", "w");
  if (!viewer) return false;
  std::fwrite(page.data(), 1, page.size(), viewer);
  return pclose(viewer) == 0;
}

}  // namespace

void add_man(Command& tool, Session& session) {
  Command& command = tool.add_command("man", "Show the manual page, or print it if the output is no terminal");
  const auto output = std::make_shared<std::string>();
  add_text_output(command, *output);
  command.footer = "Example:\n  tessera man | man -l -";
  command.choose = [output, &tool, &session] {
    session.command = [output, &tool] {
      const std::string page = man_page(tool, TESSERA_VERSION);
      return output->empty() && isatty(STDOUT_FILENO) != 0 && show(page) ? Status() : write_text(page, *output);
    };
  };
}

}  // namespace tessera::cli
