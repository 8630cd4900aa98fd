// The command line, read by CLI11. No other file knows that library: it is large, and its own exit codes are not ours.
#include "cli/command.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <map>

#include "cli/exit.h"
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

namespace {

constexpr Command kCommands[] = {
    {"render", "simulate a scene, then draw it: an MP4, a folder of PNGs, or single PNGs with --at", declare_render},
    {"simulate", "write trajectory.csv, contacts.csv and summary.json", declare_simulate},
    {"plan", "which physical effects a scene calls for, and why", declare_plan},
    {"study", "what accuracy costs in time: errors, bands and sensitivity against computing time", declare_study},
    {"sample", "many runs over what the scene does not know: percentiles, sensitivity, a table of runs", declare_sample},
    {"fit", "which inputs explain the evidence, and how sure is that", declare_fit},
    {"eval", "runs for another program: parameters from a file, measures into a file", declare_eval},
    {"figure", "report figures: site diagram, contact map, time histories, stroboscopic still, contact sheet", declare_figure},
    {"check", "read scenes and report every error", declare_check},
    {"compare", "compare two pictures", declare_compare},
    {"snapshot", "test the pictures and measures of a folder of scenes against their baselines", declare_snapshot},
    {"library", "list the persons, poses, vehicles and other entries a scene can name", declare_library},
    {"schema", "print the JSON Schema of the scene format, for editors", declare_schema},
    {"version", "print the version, the build, the libraries and the GL renderer", declare_version},
};

/// The option or command nearest to what was typed, as a remedy.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string near = scenes::nearest(word, candidates);
  return near.empty() ? "" : fmt::format("; did you mean {}?", near);
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

[[noreturn]] void refuse_leftovers(const CLI::App& app, const std::string& who) {
  const std::string first = app.remaining().front();
  if (first.starts_with("-")) {
    const std::string name = first.substr(0, first.find('='));
    throw UsageError(fmt::format("{}: unknown option {}{}", who, name, did_you_mean(name, option_names(app))));
  }
  throw UsageError(fmt::format("{}: unexpected argument \"{}\"", who, first));
}

[[noreturn]] void refuse_command(const std::string& word) {
  std::vector<std::string> names;
  for (const Command& command : kCommands) names.push_back(command.name);
  if (word.empty()) throw UsageError(fmt::format("no command given; take one of {}", fmt::join(names, ", ")));
  throw UsageError(fmt::format("unknown {} {}{}", word.starts_with("-") ? "option" : "command", word, did_you_mean(word, names)));
}

}  // namespace

std::span<const Command> commands() {
  return kCommands;
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

int run_command_line(int argc, const char* const* argv) {
  CLI::App app{"Reconstructs traffic accidents: a scene file becomes a simulation, and the simulation a film."};
  app.name("crashreel");
  app.allow_extras();
  std::map<const CLI::App*, std::function<int()>> actions;
  for (const Command& command : kCommands) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    sub->allow_extras();
    Arguments arguments(*sub);
    actions[sub] = command.declare(arguments);
  }

  // what was typed wrong is told by us: in our words, with our exit code
  std::string who = "crashreel";
  try {
    app.parse(argc, argv);
    const auto chosen = app.get_subcommands();
    if (chosen.empty()) refuse_command(app.remaining().empty() ? "" : app.remaining().front());
    const CLI::App& sub = *chosen.front();
    who += " " + sub.get_name();
    if (!sub.remaining().empty()) refuse_leftovers(sub, who);
    if (!app.remaining().empty()) refuse_leftovers(app, who);
    return actions.at(&sub)();
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app.help());
    return kDone;
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    if (!chosen.empty()) {
      who = "crashreel " + chosen.front()->get_name();
      // a missing scene is often a mistyped option that swallowed it
      if (!chosen.front()->remaining().empty()) refuse_leftovers(*chosen.front(), who);
    }
    throw UsageError(fmt::format("{}: {}; see {} --help", who, error.what(), who));
  }
}

}  // namespace cli
