#include "usage.h"

#include <CLI/CLI.hpp>
#include <vector>

#include "loading.h"
#include "suggestions.h"
#include "tessera/version.h"

namespace tessera::cli {
namespace {

constexpr const char* hint = "\nTry tessera --help, or --help after a command.";

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* const command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// Adds the option names of a command and of its option groups, which are subcommands without a name.
void add_option_names(const CLI::App& command, std::vector<std::string>& names) {
  for (const CLI::Option* const option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  for (const CLI::App* const group : command.get_subcommands({})) {
    if (group->get_name().empty()) add_option_names(*group, names);
  }
}

/// The message for a word that no option takes.
std::string fault_of_word(const CLI::App& app, const CLI::App& command, const std::string& word) {
  const bool of_tool = &command == &app;
  if (!word.starts_with('-')) {
    if (!of_tool) return "tessera " + command.get_name() + ": the word " + word + " is not expected";
    return "there is no command " + word + did_you_mean(word, command_names(app));
  }
  const std::string name = word.substr(0, word.find('='));
  std::vector<std::string> names;
  add_option_names(command, names);
  if (!of_tool) return "tessera " + command.get_name() + " has no option " + name + did_you_mean(name, names);
  return "there is no option " + name + " before a command" + did_you_mean(name, names);
}

}  // namespace

void describe(CLI::App& app) {
  app.set_version_flag("--version", "tessera " TESSERA_VERSION);
  app.require_subcommand(0, 1);  // checked after parsing instead, so that a wrong word is named first
  app.get_formatter()->column_width(28);
  app.footer(
      "Files read: surfaces as " + model_formats() +
      ";\n"
      "meshes as .obj, .ply, .stl. Surfaces are Bezier patches (.bpt), BezierView (.bv), GoTools (.g2), RenderMan\n"
      "(.rib), free-form OBJ, CAD parts (if OpenCASCADE was there at the build), and surfaces of every kind (.json;\n"
      "tools/models/FORMAT.md describes the format). A warning names each part of a file that is skipped.\n"
      "\nFiles written: meshes as .obj, .ply, .stl, .glb and .gltf; surfaces as .obj and .bpt; pictures as .png, and "
      "as\n"
      ".exr (numbers: depth, normals, parameters); tables as text. A file appears whole or not at all.\n"
      "\nSeveral files: a command takes names and quoted patterns ('parts/*.bpt'). A pattern means the files that "
      "match\n"
      "it, sorted. With one output, all files are one scene. If the output is a folder, or contains {name} (the "
      "file's\n"
      "name without folder and extension), each file gets its own result. If a file fails, the others go on.\n"
      "Surfaces, patches and rays are counted from 0. Surfaces are counted on from file to file.\n"
      "\nEnvironment: TESSERA_ISA=sse2|avx2|avx512 does the same as --isa; NO_COLOR turns colours off.\n"
      "\nExit status: 0 done, 1 an input is bad or an output cannot be written, 2 the command line is bad.\n"
      "\nExamples:\n"
      "  tessera info 'models/*.json'\n"
      "  tessera raycast teapot.bpt\n"
      "  tessera raycast teapot.bpt -o teapot.png --size 1280x720\n"
      "  tessera tessellate body.iges wing.iges -o plane.ply --grid 8x8\n"
      "  tessera convert goblet.json -o goblet.obj\n"
      "  tessera raycast 'parts/*.step' -o 'pictures/{name}.png' --json\n"
      "  eval \"$(tessera completion bash)\"");
}

std::string usage_fault(const CLI::App& app, const CLI::Error& error) {
  const CLI::App* command = &app;
  const std::vector<const CLI::App*> chosen =
      app.get_subcommands([](const CLI::App* sub) { return sub->parsed() && !sub->get_name().empty(); });
  if (!chosen.empty()) command = chosen[0];
  for (const std::string& word : command->remaining()) {
    if (word.size() > 1 && word.starts_with('-')) return fault_of_word(app, *command, word) + hint;
  }
  for (const CLI::App* of : {command, &app}) {
    const std::vector<std::string> words = of->remaining();
    if (!words.empty() && dynamic_cast<const CLI::ExtrasError*>(&error))
      return fault_of_word(app, *of, words[0]) + hint;
  }
  return error.what() + std::string(hint);
}

std::string missing_command(const CLI::App& app) {
  return "expected a command (" + listed(command_names(app), "or") + "), found none" + hint;
}

}  // namespace tessera::cli
