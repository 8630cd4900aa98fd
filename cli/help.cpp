#include "cli/help.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "engine/measure/definitions.h"
#include "scenes/loader/builder.h"

namespace cli {
namespace {

constexpr std::size_t kColumn = 34;  // where the explanations begin
constexpr std::size_t kWidth = 100;  // of a line

/// `text` in lines of kWidth, each after the first indented to kColumn.
std::string wrapped(const std::string& head, const std::string& text) {
  std::string out = "  " + head, line;
  out.append(out.size() + 1 < kColumn ? kColumn - out.size() : 0, ' ');
  if (out.size() > kColumn) out += "\n" + std::string(kColumn, ' ');
  std::size_t used = kColumn;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    if (used + end - at > kWidth && used > kColumn) {
      out += "\n" + std::string(kColumn, ' ');
      used = kColumn;
    }
    out += text.substr(at, end - at) + (end < text.size() ? " " : "");
    used += end - at + 1;
    at = end + 1;
  }
  for (std::size_t blank = out.find(" \n"); blank != std::string::npos; blank = out.find(" \n")) out.erase(blank, 1);
  return out + "\n";
}

std::string with_value(const ArgumentHelp& argument) {
  return argument.value.empty() ? argument.names : argument.names + " " + argument.value;
}

std::string usage_of(const CommandHelp& help) {
  std::string out = fmt::format("crashreel {}", help.command->name);
  for (const ArgumentHelp& a : help.arguments)
    if (a.positional || a.required)
      out += " " + (a.positional ? a.names : with_value(a).substr(0, with_value(a).find(',')) + " " + a.value);
  return out + " [options]";
}

std::string examples_of(const Command& command) {
  std::string out;
  for (const Example& example : command.examples) out += fmt::format("  crashreel {}\n      {}\n", example.line, example.does);
  return out;
}

/// Text for roff: nothing in it is a command.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out.starts_with(".") || out.starts_with("'") ? "\\&" + out : out;
}

std::string page_head(const std::string& name, const std::string& summary) {
  return fmt::format(".TH {} 1 \"\" \"crashreel {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", roff(name), CRASHREEL_VERSION,
                     roff(name), roff(summary));
}

std::string roff_examples(const Command& command) {
  std::string out;
  for (const Example& example : command.examples)
    out += fmt::format(".TP\n.B crashreel {}\n{}\n", roff(example.line), roff(example.does));
  return out;
}

const std::vector<std::pair<const char*, const char*>>& exit_codes() {
  static const std::vector<std::pair<const char*, const char*>> codes = {
      {"0", "done"},
      {"1", "compare or snapshot says no"},
      {"2", "the scene or the command line is wrong; the message says where and what to write instead"},
      {"3", "the machine failed: a file, GL, the encoder"},
      {"4", "the model diverged; the recording up to there has been written or drawn"},
      {"129, 130, 143", "stopped by SIGHUP, SIGINT or SIGTERM"},
      {"141", "nobody reads standard output any more, as with | head; files are whole"}};
  return codes;
}

std::string roff_common(const std::string& see_also) {
  std::string out = ".SH EXIT STATUS\n";
  for (const auto& [code, means] : exit_codes()) out += fmt::format(".TP\n{}\n{}\n", code, roff(means));
  return out +
         ".SH ENVIRONMENT\n.TP\n.B CRASHREEL_HOME\nThe folder that holds scenes/library and assets, in place of the installed "
         "one.\n"
         ".TP\n.B NO_COLOR\nNo colours on the terminal.\n.SH FILES\n"
         ".TP\n.I /usr/share/doc/crashreel/scenes/GUIDE.md\nThe guide: half an hour to a case of your own.\n"
         ".TP\n.I /usr/share/crashreel/scenes\nScenes to copy and try, and the library.\n.SH SEE ALSO\n" +
         see_also + "\n";
}

/// Long and short names of an option, one by one: "-o", "--output".
std::vector<std::string> names_of(const ArgumentHelp& argument) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < argument.names.size();) {
    const std::size_t end = std::min(argument.names.find(',', at), argument.names.size());
    out.push_back(argument.names.substr(at, end - at));
    at = end + 1;
  }
  return out;
}

std::string choices_of(const ArgumentHelp& argument) {
  std::string out =
      argument.value.find('|') == std::string::npos || argument.value.find('=') != std::string::npos ? "" : argument.value;
  std::replace(out.begin(), out.end(), '|', ' ');
  return out;
}

std::string command_names(const std::vector<CommandHelp>& all) {
  std::string out;
  for (const CommandHelp& help : all) out += (out.empty() ? "" : " ") + std::string(help.command->name);
  return out;
}

/// What may stand after these commands; after the others stand files.
std::string words_after(const std::string& command, const std::vector<CommandHelp>& all) {
  if (command == "man") return command_names(all);
  if (command == "completion") return "bash zsh fish";
  if (command != "explain") return "";
  std::string out = "all";
  for (const engine::Definition& d : engine::definitions()) out += std::string(" ") + d.key;
  return out;
}

/// The guide, where this program finds it: in the source, or where it is installed.
std::string guide_place() {
  const std::filesystem::path home = scenes::home_folder();
  std::error_code problem;
  for (const auto& place : {home / "scenes/GUIDE.md", home.parent_path() / "doc/crashreel/scenes/GUIDE.md"})
    if (std::filesystem::exists(place, problem)) return place.string();
  return "scenes/GUIDE.md";
}

std::string single_quoted(std::string text) {
  for (std::size_t at = text.find('\''); at != std::string::npos; at = text.find('\'', at + 4)) text.replace(at, 1, "'\\''");
  return "'" + text + "'";
}

std::string bash(const std::vector<CommandHelp>& all) {
  std::string out =
      "# bash completion of crashreel\n_crashreel() {\n  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
      "  COMPREPLY=()\n  if [ \"$COMP_CWORD\" -eq 1 ]; then\n";
  out += fmt::format("    mapfile -t COMPREPLY < <(compgen -W \"{} --help --version\" -- \"$word\")\n    return\n  fi\n",
                     command_names(all));
  out += "  case ${COMP_WORDS[1]} in\n";
  for (const CommandHelp& help : all) {
    std::string options = "--help", values;
    for (const ArgumentHelp& a : help.arguments) {
      if (a.positional) continue;
      for (const std::string& name : names_of(a)) options += " " + name;
      if (!choices_of(a).empty())
        values += fmt::format("        {}) mapfile -t COMPREPLY < <(compgen -W \"{}\" -- \"$word\"); return ;;\n",
                              names_of(a).back(), choices_of(a));
    }
    out += fmt::format("    {})\n", help.command->name);
    if (!values.empty()) out += "      case $before in\n" + values + "      esac\n";
    if (const std::string words = words_after(help.command->name, all); !words.empty())
      out += fmt::format("      mapfile -t COMPREPLY < <(compgen -W \"{}\" -- \"$word\")\n", words);
    out += fmt::format("      [[ $word == -* ]] && mapfile -t COMPREPLY < <(compgen -W \"{}\" -- \"$word\") ;;\n", options);
  }
  return out + "  esac\n}\ncomplete -o default -F _crashreel crashreel\n";
}

std::string zsh(const std::vector<CommandHelp>& all) {
  // within single quotes, where brackets and colons part what stands in them
  const auto escaped = [](const std::string& text) {
    std::string out;
    for (const char c : text) {
      if (c == '[' || c == ']' || c == ':') out += '\\';
      out += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return out;
  };
  std::string out = "#compdef crashreel\n_crashreel() {\n  if (( CURRENT == 2 )); then\n    local -a commands=(\n";
  for (const CommandHelp& help : all) out += fmt::format("      '{}:{}'\n", help.command->name, escaped(help.command->summary));
  out += "    )\n    _describe command commands\n    return\n  fi\n  case $words[2] in\n";
  for (const CommandHelp& help : all) {
    out += fmt::format("    {}) _arguments", help.command->name);
    for (const ArgumentHelp& a : help.arguments) {
      if (a.positional) continue;
      const std::string value = a.value.empty() ? "" : choices_of(a).empty() ? ": :_files" : fmt::format(": :({})", choices_of(a));
      for (const std::string& name : names_of(a)) out += fmt::format(" \\\n        '*{}[{}]{}'", name, escaped(a.text), value);
    }
    const std::string words = words_after(help.command->name, all);
    out += fmt::format(" \\\n        '*: :{}' ;;\n", words.empty() ? "_files" : "(" + words + ")");
  }
  return out + "  esac\n}\n_crashreel \"$@\"\n";
}

std::string fish(const std::vector<CommandHelp>& all) {
  std::string out = "# fish completion of crashreel\n";
  for (const CommandHelp& help : all) {
    out += fmt::format("complete -c crashreel -n __fish_use_subcommand -f -a {} -d {}\n", help.command->name,
                       single_quoted(help.command->summary));
    if (const std::string words = words_after(help.command->name, all); !words.empty())
      out += fmt::format("complete -c crashreel -n '__fish_seen_subcommand_from {}' -f -a {}\n", help.command->name,
                         single_quoted(words));
    for (const ArgumentHelp& a : help.arguments) {
      if (a.positional) continue;
      out += fmt::format("complete -c crashreel -n '__fish_seen_subcommand_from {}'", help.command->name);
      for (const std::string& name : names_of(a)) out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (!a.value.empty()) out += choices_of(a).empty() ? " -r" : fmt::format(" -x -a {}", single_quoted(choices_of(a)));
      out += fmt::format(" -d {}\n", single_quoted(a.text));
    }
  }
  return out;
}

}  // namespace

std::string help_of(const CommandHelp& help) {
  std::string out = fmt::format("crashreel {}: {}\n\nExamples\n{}\nUsage\n  {}\n\n", help.command->name, help.command->summary,
                                examples_of(*help.command), usage_of(help));
  for (const bool positional : {true, false}) {
    if (!positional) out += "Options\n";
    for (const ArgumentHelp& a : help.arguments)
      if (a.positional == positional) out += wrapped(with_value(a), a.text + (a.required && !positional ? " (required)" : ""));
  }
  return out + fmt::format("\nSee also: man crashreel-{}, {}\n", help.command->name, guide_place());
}

std::string overview_of(const std::vector<CommandHelp>& all) {
  std::string out =
      "crashreel reconstructs traffic accidents: a scene file becomes a simulation, and the simulation a film.\n\nExamples\n"
      "  crashreel check case.toml                 every error of a scene, with its remedy\n"
      "  crashreel simulate case.toml -o out       measures, trajectory.csv, contacts.csv, impacts.csv, summary.json\n"
      "  crashreel render case.toml -o case.mp4    the film\n\nCommands\n";
  for (const CommandHelp& help : all) out += wrapped(help.command->name, help.command->summary);
  return out + "\ncrashreel COMMAND --help shows examples and options of a command; crashreel --version the version.\n";
}

std::string man_page_of(const CommandHelp& help) {
  std::string out = page_head(fmt::format("crashreel-{}", help.command->name), help.command->summary);
  out += ".SH SYNOPSIS\n.B " + roff(usage_of(help)) + "\n.SH EXAMPLES\n" + roff_examples(*help.command) + ".SH OPTIONS\n";
  for (const ArgumentHelp& a : help.arguments) out += fmt::format(".TP\n.B {}\n{}\n", roff(with_value(a)), roff(a.text));
  return out + roff_common(".BR crashreel (1)");
}

std::string man_page_of(const std::vector<CommandHelp>& all) {
  std::string out = page_head("crashreel", "reconstruct traffic accidents and show them as pictures");
  out +=
      ".SH SYNOPSIS\n.B crashreel COMMAND [options]\n.SH DESCRIPTION\nA scene file becomes a simulation, and the simulation a "
      "film, "
      "stills, figures and tables.\n.SH EXAMPLES\n" +
      roff_examples(*all.front().command) + ".SH COMMANDS\n";
  std::string pages;
  for (const CommandHelp& help : all) {
    out += fmt::format(".TP\n.B {}\n{}\n", help.command->name, roff(help.command->summary));
    pages += fmt::format("{}.BR crashreel\\-{} (1)", pages.empty() ? "" : ",\n", help.command->name);
  }
  return out + roff_common(pages);
}

std::string completion_for(const std::string& shell, const std::vector<CommandHelp>& all) {
  if (shell == "bash") return bash(all);
  return shell == "zsh" ? zsh(all) : fish(all);
}

}  // namespace cli
