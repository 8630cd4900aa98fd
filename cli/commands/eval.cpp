// crashreel eval SCENE PARAMS RESULTS: runs for another program.
#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <sstream>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/inference/crew.h"
#include "cli/inference/driver.h"
#include "cli/output/whole_file.h"
#include "cli/parse.h"
#include "cli/scene_run.h"
#include "cli/study/pool.h"

namespace cli {
namespace {

struct EvalWish {
  SceneArguments scene;
  std::string parameters, results, jobs;
  std::vector<std::string> measures;
};

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw UsageError(fmt::format("{}: cannot be read as a parameters file; check the path and its permissions", file));
  return text.str();
}

/// Several names in one argument stand between commas, as values of --grid do.
std::vector<std::string> separated(const std::vector<std::string>& arguments) {
  std::vector<std::string> out;
  for (const std::string& argument : arguments) {
    std::istringstream names(argument);
    for (std::string name; std::getline(names >> std::ws, name, ',');)
      if (!name.empty()) out.push_back(name);
  }
  return out;
}

int evaluate(const EvalWish& wish) {
  const int jobs = wish.jobs.empty() ? study::available_cores() : parse_integer("--jobs", wish.jobs, 1, 1024);
  const scenes::Scene scene = load_scene(wish.scene);
  plan_of(scene);  // refuses effects that do not exist
  inference::Request request = inference::read_request(scene, text_of(wish.parameters));
  if (!wish.measures.empty()) request.measures = separated(wish.measures);
  std::vector<inference::Answer> answers(request.values.size());
  const auto work = [&](std::size_t k) {
    return inference::as_line("", inference::answer(scene, inference::overrides_of(request, k)));
  };
  const auto take = [&](std::size_t k, const std::string& line, const std::string& death) {
    auto found = inference::from_line(line);
    if (found) answers[k] = std::move(found->second);
    if (!found) answers[k].status = "the run's process ended: " + death;
  };
  inference::run_crew(answers.size(), jobs, work, take);
  write_whole(wish.results, inference::results(request, answers));
  const int failed = inference::failed(request, answers);
  if (failed > 0 && !wish.scene.quiet)
    fmt::print(stderr, "crashreel: {} of {} runs failed; {} says why\n", failed, answers.size(), wish.results);
  Notices notices;
  for (const inference::Answer& a : answers) notices.add(a.notes);
  for (const std::string& notice : wish.scene.quiet ? std::vector<std::string>() : in_words(notices))
    fmt::print(stderr, "crashreel: warning: {}\n", notice);
  return failed > 0 ? kModelDiverged : kDone;
}

int run(const EvalWish& wish) {
  try {
    return evaluate(wish);
  } catch (const std::exception& error) {
    // whoever waits for the file finds it, whatever went wrong
    write_whole(wish.results, fmt::format("fail\n{}\n", error.what()));
    throw;
  }
}

}  // namespace

std::function<int()> declare_eval(Arguments& arguments) {
  const auto wish = std::make_shared<EvalWish>();
  declare_scene_file(arguments, wish->scene);
  arguments.positional("PARAMS", wish->parameters,
                       "parameters: Dakota's standard format, or CSV with keys in the first line; bare numbers in SI");
  arguments.positional("RESULTS", wish->results,
                       "results: always written, begins with \"fail\" where there are none; replaced if it exists");
  arguments.repeatable("--measure", wish->measures, "NAME",
                       "only these measures, in this order, repeated or A,B (default: those PARAMS asks for, else all)");
  arguments.option("--jobs", wish->jobs, "N", "runs side by side (default: every core)");
  return [wish] { return run(*wish); };
}

}  // namespace cli
