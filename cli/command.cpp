// The command line, read by CLI11. No other file knows that library: it is large, and its own exit codes are not ours.
#include "cli/command.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

#include "cli/exit.h"
#include "cli/help.h"
#include "scenes/loader/value.h"

namespace cli {

std::function<int()> declare_render(Arguments&);
std::function<int()> declare_simulate(Arguments&);
std::function<int()> declare_plan(Arguments&);
std::function<int()> declare_study(Arguments&);
std::function<int()> declare_sample(Arguments&);
std::function<int()> declare_fit(Arguments&);
std::function<int()> declare_eval(Arguments&);
std::function<int()> declare_figure(Arguments&);
std::function<int()> declare_check(Arguments&);
std::function<int()> declare_compare(Arguments&);
std::function<int()> declare_snapshot(Arguments&);
std::function<int()> declare_library(Arguments&);
std::function<int()> declare_schema(Arguments&);
std::function<int()> declare_version(Arguments&);
std::function<int()> declare_explain(Arguments&);
std::function<int()> declare_man(Arguments&);
std::function<int()> declare_completion(Arguments&);

namespace {

constexpr Example kRenderExamples[] = {
    {"render case.toml -o case.mp4", "the film, as the scene's shots say"},
    {"render case.toml --at 0.2s --at 0.5s -o still.png", "two stills of one run"},
    {"render case.toml --camera top --camera side -o case.mp4", "the whole run from two cameras, simulated once"},
    {"render case.toml --set vehicle.sedan.speed=\"50 km/h\" -o faster.mp4", "another speed; the title says so"},
    {"render case.toml --size 320x180 --quality draft", "a quick look"},
};
constexpr Example kSimulateExamples[] = {
    {"simulate case.toml -o out", "trajectory.csv, contacts.csv, impacts.csv and summary.json in the folder out"},
    {"simulate case.toml -o out --json", "the summary as JSON on standard output as well"},
    {"simulate case.toml -o out --dry-run", "how long it will take"},
};
constexpr Example kPlanExamples[] = {
    {"plan case.toml", "which effects act, and what is left out"},
    {"plan case.toml --measure", "what each of them costs"},
};
constexpr Example kStudyExamples[] = {
    {"study case.toml -o out", "how certain the answer is, numerically"},
    {"study case.toml -o out --input vehicle.sedan.speed=\"39 km/h..41 km/h\"", "what a range of an input does"},
    {"study case.toml -o out --target throw_distance=0.05m", "the cheapest setting that holds it"},
};
constexpr Example kSampleExamples[] = {
    {"sample case.toml -n 1000 -o out", "1000 runs over the inputs under [[uncertain]]"},
};
constexpr Example kFitExamples[] = {
    {"fit case.toml -o out", "the inputs that explain what stands under [[evidence]], with intervals"},
};
constexpr Example kEvalExamples[] = {
    {"eval case.toml params.in results.out", "one run for an outside tool"},
};
constexpr Example kFigureExamples[] = {
    {"figure case.toml -o out", "site diagram, contact map, time histories and stills"},
};
constexpr Example kCheckExamples[] = {
    {"check case.toml", "every error with its place and remedy"},
    {"check *.toml --json", "file, line, column, code and message for an editor"},
};
constexpr Example kCompareExamples[] = {
    {"compare a.png b.png --diff difference.png", "exit code 1 where they are not the same picture"},
};
constexpr Example kSnapshotExamples[] = {
    {"snapshot scenes", "do the scenes still look and measure as they did?"},
    {"snapshot scenes --update my_case.toml", "accept the new pictures of one scene"},
};
constexpr Example kLibraryExamples[] = {{"library", "persons, poses and vehicles by name"}};
constexpr Example kExplainExamples[] = {{"explain delta_v", "what is printed as delta_v_mps"},
                                        {"explain all", "every measure, as a table"}};
constexpr Example kSchemaExamples[] = {{"schema > scene.schema.json", "for an editor that completes and checks scenes"}};
constexpr Example kVersionExamples[] = {{"version", "what a report must name to be repeatable"}};
constexpr Example kManExamples[] = {{"man render | man -l -", "read the page of a command"}};
constexpr Example kCompletionExamples[] = {{"completion bash > ~/.local/share/bash-completion/completions/crashreel", "for bash"}};

constexpr Command kCommands[] = {
    {"render", "simulate a scene, then draw it: an MP4, a folder of PNGs, or single PNGs with --at", declare_render,
     kRenderExamples},
    {"simulate", "write trajectory.csv, contacts.csv, impacts.csv and summary.json", declare_simulate, kSimulateExamples},
    {"plan", "which physical effects a scene calls for, and why", declare_plan, kPlanExamples},
    {"study", "what accuracy costs in time: errors, bands and sensitivity against computing time", declare_study, kStudyExamples},
    {"sample", "many runs over what the scene does not know: percentiles, sensitivity, a table of runs", declare_sample,
     kSampleExamples},
    {"fit", "which inputs explain the evidence, and how sure is that", declare_fit, kFitExamples},
    {"eval", "runs for another program: parameters from a file, measures into a file", declare_eval, kEvalExamples},
    {"figure", "report figures: site diagram, contact map, time histories, stroboscopic still, contact sheet", declare_figure,
     kFigureExamples},
    {"check", "read scenes and report every error", declare_check, kCheckExamples},
    {"compare", "compare two pictures", declare_compare, kCompareExamples},
    {"snapshot", "test the pictures and measures of a folder of scenes against their baselines", declare_snapshot,
     kSnapshotExamples},
    {"library", "list the persons, poses, vehicles and other entries a scene can name", declare_library, kLibraryExamples},
    {"explain", "what a measure means: unit, definition with source, when it is absent, how sure it is", declare_explain,
     kExplainExamples},
    {"schema", "print the JSON Schema of the scene format, for editors", declare_schema, kSchemaExamples},
    {"version", "print the version, the build, the libraries and the GL renderer", declare_version, kVersionExamples},
    {"man", "print the manual page of a command", declare_man, kManExamples},
    {"completion", "print the completion of command lines for a shell", declare_completion, kCompletionExamples},
};

/// The option or command nearest to what was typed, as a remedy.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string near = scenes::nearest(word, candidates);
  // "--seed" is two letters from "--set" and means something else: a short word must come nearer
  const std::size_t letters = word.size() - std::min(word.size(), word.find_first_not_of('-'));
  const std::size_t differ = near.size() > word.size() ? near.size() - word.size() : word.size() - near.size();
  const bool far = word.starts_with("--") && near.size() < 6 && (differ > 1 || letters < 5) && !near.starts_with(word);
  return near.empty() || far ? "" : fmt::format("; did you mean {}?", near);
}

/// A value of the scene given as an option: --speed 50.
std::string instead_of_option(const std::string& name, const std::vector<std::string>& options) {
  const std::string near = did_you_mean(name, options);
  const bool sets = std::find(options.begin(), options.end(), "--set") != options.end();
  if (!near.empty() || !sets) return near;
  return "; values of the scene are changed by --set, like --set vehicle.sedan.speed=\"50 km/h\"";
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// A shell parts a name with spaces: words that together name a file.
std::string quotes_for(const std::string& word, const std::vector<std::string>& words) {
  const auto end = std::find(words.begin(), words.end(), word);
  std::string name = word;
  for (auto begin = end; end != words.end() && begin != words.begin();) {
    name = *--begin + " " + name;
    std::error_code none;
    if (std::filesystem::exists(name, none)) return fmt::format("; a name with spaces stands in quotes: \"{}\"", name);
  }
  return "";
}

/// `words` are those of the command line, as typed.
[[noreturn]] void refuse_leftovers(const CLI::App& app, const std::string& who, const std::vector<std::string>& words) {
  const std::string first = app.remaining().front();
  if (first.starts_with("-")) {
    const std::string name = first.substr(0, first.find('='));
    throw UsageError(fmt::format("{}: unknown option {}{}", who, name, instead_of_option(name, option_names(app))));
  }
  throw UsageError(fmt::format("{}: unexpected argument \"{}\"{}", who, first, quotes_for(first, words)));
}

/// A missing option as it is typed: "-o DIR is required".
std::string as_typed(const CLI::App& app, const std::string& what) {
  for (const CLI::Option* option : app.get_options())
    if (!option->get_snames().empty() && what == option->get_name() + " is required")
      return fmt::format("-{} {} is required", option->get_snames().front(), option->get_type_name());
  return what;
}

/// What --help of a command, or of the program, prints.
std::string help_text(const std::string& chosen) {
  const std::vector<CommandHelp> all = help_of_commands();
  for (const CommandHelp& help : all)
    if (help.command->name == chosen) return help_of(help);
  return overview_of(all);
}

/// `crashreel --version` and `crashreel help render` as people type them, in the words of the table.
std::vector<std::string> as_commands(int argc, const char* const* argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (!words.empty() && (words[0] == "--version" || words[0] == "-V")) words[0] = "version";
  if (!words.empty() && words[0] == "help") {
    words.erase(words.begin());
    words.push_back("--help");
  }
  // behind a command CLI11 takes the name of another for that command
  if (words.size() > 1 && words[0] == "man" && !words[1].starts_with("-")) words[1] = "--page=" + words[1];
  return words;
}

}  // namespace

std::span<const Command> commands() {
  return kCommands;
}

void refuse_command(const std::string& word) {
  std::vector<std::string> names;
  for (const Command& command : kCommands) names.push_back(command.name);
  if (word.empty()) throw UsageError(fmt::format("no command given; take one of {}; see crashreel --help", fmt::join(names, ", ")));
  throw UsageError(fmt::format("unknown {} {}{}", word.starts_with("-") ? "option" : "command", word, did_you_mean(word, names)));
}

void Arguments::positional(const std::string& name, std::string& target, const std::string& help) {
  app_.add_option(name, target, help)->required();
}

void Arguments::positionals(const std::string& name, std::vector<std::string>& target, const std::string& help) {
  app_.add_option(name, target, help)->required()->expected(1, -1);
}

void Arguments::option(const std::string& names, std::string& target, const std::string& value_name, const std::string& help) {
  app_.add_option(names, target, help)->type_name(value_name)->take_last();
}

void Arguments::required_option(const std::string& names, std::string& target, const std::string& value_name,
                                const std::string& help) {
  app_.add_option(names, target, help)->type_name(value_name)->take_last()->required();
}

void Arguments::repeatable(const std::string& names, std::vector<std::string>& target, const std::string& value_name,
                           const std::string& help) {
  app_.add_option(names, target, help)
      ->type_name(value_name)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
}

void Arguments::list(const std::string& names, bool& given, std::vector<std::string>& target, const std::string& value_name,
                     const std::string& help) {
  const auto take = [&given, &target](const std::vector<std::string>& values) {
    given = true;
    for (const std::string& value : values)
      if (!value.empty() && value != "{}") target.push_back(value);  // what CLI11 puts where no value stands
  };
  app_.add_option_function<std::vector<std::string>>(names, take, help)->type_name(value_name)->expected(0, 1 << 20);
}

void Arguments::choice(const std::string& names, std::string& target, const std::vector<std::string>& choices,
                       const std::string& help) {
  const auto known = [names, choices](const std::string& word) {
    for (const std::string& choice : choices) {
      if (word == choice) return std::string();
    }
    return fmt::format("\"{}\" is none of {}", word, fmt::join(choices, ", "));
  };
  app_.add_option(names, target, help)->type_name(fmt::format("{}", fmt::join(choices, "|")))->take_last()->check(known);
}

void Arguments::flag(const std::string& names, bool& target, const std::string& help) {
  app_.add_flag(names, target, help);
}

std::vector<std::pair<std::string, std::string>> Arguments::given() const {
  std::vector<std::pair<std::string, std::string>> out;
  for (const CLI::Option* option : app_.get_options()) {
    // positionals have no long name; what they name is read and hashed itself
    if (option->count() == 0 || option->get_lnames().empty()) continue;
    out.emplace_back("--" + option->get_lnames().front(), fmt::format("{}", fmt::join(option->results(), "\n")));
  }
  return out;
}

std::vector<CommandHelp> help_of_commands() {
  std::vector<CommandHelp> out;
  for (const Command& command : kCommands) {
    CLI::App app;
    app.set_help_flag();
    Arguments arguments(app);
    command.declare(arguments);
    out.push_back({&command, {}});
    for (const CLI::Option* option : app.get_options()) {
      const bool positional = option->get_lnames().empty();
      const bool flag = !positional && option->get_items_expected_max() == 0;
      out.back().arguments.push_back({option->get_name(positional, !positional), flag || positional ? "" : option->get_type_name(),
                                      option->get_description(), positional, option->get_required()});
    }
  }
  return out;
}

std::function<int()> read_command_line(int argc, const char* const* argv) {
  // a job asks for the options it was given while it runs: it keeps them
  const auto app =
      std::make_shared<CLI::App>("Reconstructs traffic accidents: a scene file becomes a simulation, and the simulation a film.");
  app->name("crashreel");
  app->allow_extras();
  const std::vector<std::string> words = as_commands(argc, argv);
  std::map<const CLI::App*, std::function<int()>> actions;
  for (const Command& command : kCommands) {
    CLI::App* sub = app->add_subcommand(command.name, command.summary);
    sub->allow_extras();
    // all of them have hundreds of options
    if (std::find(words.begin(), words.end(), command.name) == words.end()) continue;
    Arguments arguments(*sub);
    actions[sub] = command.declare(arguments);
  }

  // what was typed wrong is told by us: in our words, with our exit code
  std::string who = "crashreel";
  try {
    app->parse(std::vector<std::string>(words.rbegin(), words.rend()));  // as the library takes them
    const auto chosen = app->get_subcommands();
    if (chosen.empty()) refuse_command(app->remaining().empty() ? "" : app->remaining().front());
    const CLI::App& sub = *chosen.front();
    who += " " + sub.get_name();
    if (!sub.remaining().empty()) refuse_leftovers(sub, who, words);
    if (!app->remaining().empty()) refuse_leftovers(*app, who, words);
    return [app, job = actions.at(&sub)] { return job(); };
  } catch (const CLI::CallForHelp&) {
    const auto asked = app->get_subcommands();
    if (asked.empty() && !app->remaining().empty()) refuse_command(app->remaining().front());
    return [of = asked.empty() ? "" : asked.front()->get_name()] {
      fmt::print("{}", help_text(of));
      return static_cast<int>(kDone);
    };
  } catch (const CLI::ParseError& error) {
    const auto chosen = app->get_subcommands();
    if (!chosen.empty()) {
      who = "crashreel " + chosen.front()->get_name();
      // a missing scene is often a mistyped option that swallowed it
      if (!chosen.front()->remaining().empty()) refuse_leftovers(*chosen.front(), who, words);
    }
    const std::string what = chosen.empty() ? error.what() : as_typed(*chosen.front(), error.what());
    throw UsageError(fmt::format("{}: {}; see {} --help", who, what, who));
  }
}

int run_command_line(int argc, const char* const* argv) {
  return read_command_line(argc, argv)();
}

}  // namespace cli
