#include "cli/inference/ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "cli/build_id.h"
#include "cli/exit.h"
#include "cli/inference/crew.h"
#include "cli/output/whole_file.h"
#include "cli/process.h"
#include "scenes/loader/sha256.h"

namespace cli::inference {
namespace {

std::string name_of(const std::vector<std::string>& overrides) {
  return fmt::format("{}", fmt::join(overrides, "\x1f"));
}

/// What every line of a journal rests on.
std::string head_of(const scenes::Scene& scene) {
  return "crashreel runs " + scenes::sha256(scene.sha256 + scene.assets_sha256 + build_id()) + "\n";
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& part)
    : lock_(folder / (part.empty() ? "runs" : "runs-" + part), [whole = part.empty()](const std::string& name) {
        if (!whole) return false;  // a part writes nothing but its journal
        for (const char* ours : {"runs.", "sample.", "fit.", "posterior.", "best.", "rest_"})
          if (name.starts_with(ours)) return true;
        return false;
      }) {}

Ensemble::Ensemble(const scenes::Scene& scene, EnsembleWish wish) : scene_(scene), wish_(std::move(wish)) {
  tell_when_stopped(
      fmt::format("finished runs are kept in {}/runs, and the same command goes on from there", wish_.folder.string()));
  make_writable_folder(wish_.folder);
  make_writable_folder(wish_.folder / "runs");
  const std::string head = head_of(scene_);
  journal_ = wish_.folder / "runs" / (head.substr(15, 32) + (wish_.part.empty() ? "" : "." + wish_.part) + ".jsonl");
  recall();
}

/// The lines that are whole.
std::string Ensemble::recall(const std::filesystem::path& journal) {
  std::ifstream in(journal);
  std::string all;
  for (std::string line; std::getline(in, line);) {
    const auto found = from_line(line);
    if (!found) continue;  // the last line of a job that was killed
    known_.insert(*found);
    all += line + "\n";
  }
  return all;
}

void Ensemble::recall() {
  const std::string ours = journal_.filename().string().substr(0, 32);
  for (const auto& entry : std::filesystem::directory_iterator(journal_.parent_path()))
    if (entry.path().filename().string().starts_with(ours) && entry.path() != journal_) recall(entry.path());
  // written anew, so that a broken last line does not swallow the next one; those of other parts are theirs
  if (std::filesystem::exists(journal_)) write_whole(journal_, recall(journal_));
}

void Ensemble::keep(const std::string& name, const Answer& a) {
  std::ofstream out(journal_, std::ios::app | std::ios::binary);
  out << as_line(name, a) << std::flush;
  if (!out) throw MachineError(fmt::format("writing {}: the disk may be full", journal_.string()));
  known_[name] = a;
}

std::vector<Answer> Ensemble::run(const std::vector<std::vector<std::string>>& runs, const std::string& stage) {
  std::vector<std::size_t> waiting;
  std::set<std::string> asked;  // a posterior that rests on few runs draws each of them many times
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (const std::string name = name_of(runs[i]); !known_.contains(name) && asked.insert(name).second) waiting.push_back(i);
  Progress progress(stage.empty() ? wish_.verb : wish_.verb + " " + stage, "runs", static_cast<double>(waiting.size()), wish_.show);
  std::size_t done = 0;
  const auto work = [&](std::size_t k) { return as_line(name_of(runs[waiting[k]]), answer(scene_, runs[waiting[k]])); };
  const auto take = [&](std::size_t k, const std::string& line, const std::string& death) {
    auto found = line.empty() ? std::nullopt : from_line(line);
    Answer a = found ? std::move(found->second) : Answer{};
    if (!found) a.status = "the run's process ended: " + death;
    keep(name_of(runs[waiting[k]]), a);
    progress.at(static_cast<double>(++done));
  };
  run_crew(waiting.size(), wish_.jobs, work, take);
  progress.finish(static_cast<double>(done));
  std::vector<Answer> out;
  for (const auto& overrides : runs) out.push_back(known_.at(name_of(overrides)));
  return out;
}

}  // namespace cli::inference
