#include "studies/explore/slurm.h"

#include <sys/wait.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "models/base/error.h"
#include "traces/whole_file.h"

namespace quadrille::studies::explore {
namespace {

namespace fs = std::filesystem;

struct Answer {
  int code = 0;
  std::string text;  ///< both streams, without the last line's end
};

Answer ask(const std::vector<std::string>& words) {
  FILE* const pipe = popen((shell_words(words) + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw user_error("{}: cannot be started", words.front());
  Answer answer;
  std::array<char, 4096> part{};
  while (const std::size_t got = std::fread(part.data(), 1, part.size(), pipe)) answer.text.append(part.data(), got);
  const int status = pclose(pipe);
  answer.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  while (answer.text.ends_with('\n')) answer.text.pop_back();
  return answer;
}

class Cluster {
 public:
  Cluster(const SlurmSetting& setting, Results& results, const std::function<std::size_t(std::size_t)>& missing)
      : setting_(setting), results_(results), missing_(missing) {}

  void run() {
    fs::create_directories(setting_.folder);
    collect();
    std::string job = earlier_job();
    std::size_t left = missing_points();
    for (int tries = 0; left > 0;) {
      if (job.empty()) job = submit();
      wait(job);
      job.clear();
      collect();
      const std::size_t now = missing_points();
      tries = now < left ? 0 : tries + 1;
      left = now;
      if (left > 0 && tries >= setting_.tries)
        throw user_error("{}: {} points got no further in {} submissions; part-*.log there say why", setting_.folder,
                         left, tries);
    }
    fs::remove(job_file());
  }

 private:
  [[nodiscard]] fs::path job_file() const { return fs::path(setting_.folder) / "job"; }
  [[nodiscard]] std::string part_file(std::size_t part, const char* ending) const {
    return (fs::path(setting_.folder) / fmt::format("part-{}{}", part, ending)).string();
  }
  [[nodiscard]] std::size_t missing_points() const {
    std::size_t all = 0;
    for (std::size_t part = 0; part < setting_.parts; ++part) all += missing_(part);
    return all;
  }
  /// The job of a program that was ended while it waited; none when Slurm does not know it any more.
  [[nodiscard]] std::string earlier_job() const {
    std::ifstream file(job_file());
    std::string job;
    if (!std::getline(file, job) || job.empty() || !is_queued(job)) return {};
    setting_.say(fmt::format("goes on with job {}", job));
    return job;
  }
  [[nodiscard]] static bool is_queued(const std::string& job) {
    const Answer answer = ask({"squeue", "--noheader", "--jobs", job, "--format", "%T"});
    return answer.code == 0 && !answer.text.empty();
  }
  [[nodiscard]] std::string submit() const {
    std::vector<std::size_t> parts;
    for (std::size_t part = 0; part < setting_.parts; ++part)
      if (missing_(part) > 0) parts.push_back(part);
    // $SLURM_ARRAY_TASK_ID is the part; a shell of the node puts it in.
    const std::string script =
        fmt::format("#!/bin/sh\nexec {} --part \"$SLURM_ARRAY_TASK_ID/{}\" --out {}/part-\"$SLURM_ARRAY_TASK_ID\".db\n",
                    shell_words(setting_.command), setting_.parts, shell_words({setting_.folder}));
    const std::string path = (fs::path(setting_.folder) / "task.sh").string();
    traces::write_whole_file(path, std::as_bytes(std::span(script)));
    std::vector<std::string> words{"sbatch", "--parsable", "--array=" + array_list(parts),
                                   "--output=" + (fs::path(setting_.folder) / "part-%a.log").string(),
                                   "--chdir=" + fs::current_path().string()};
    words.insert(words.end(), setting_.options.begin(), setting_.options.end());
    words.push_back(path);
    const Answer answer = ask(words);
    if (answer.code != 0) throw user_error("sbatch: {}", answer.text);
    const std::string job = answer.text.substr(0, answer.text.find(';'));  // a cluster's name may follow
    traces::write_whole_file(job_file().string(), std::as_bytes(std::span(job)));
    setting_.say(fmt::format("job {} with {} parts", job, parts.size()));
    return job;
  }
  void wait(const std::string& job) const {
    while (is_queued(job)) {
      std::this_thread::sleep_for(std::chrono::duration<double>(setting_.seconds_between_looks));
      collect();
      setting_.say(fmt::format("job {}: {} points to go", job, missing_points()));
    }
  }
  void collect() const {
    for (std::size_t part = 0; part < setting_.parts; ++part) {
      const std::string file = part_file(part, ".db");
      if (!fs::exists(file)) continue;
      try {
        (void)results_.take_over(file);
      } catch (const UserError&) {  // its tables are not there yet, or it is busy: looked at again later
      } catch (const ResultsNotWritten& error) { throw user_error("the results cannot be written: {}", error.what()); }
    }
  }

  const SlurmSetting& setting_;
  Results& results_;
  const std::function<std::size_t(std::size_t)>& missing_;
};

}  // namespace

std::string array_list(const std::vector<std::size_t>& parts) { return fmt::format("{}", fmt::join(parts, ",")); }

std::string shell_words(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    line += line.empty() ? "'" : " '";
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += "'";
  }
  return line;
}

void run_on_slurm(const SlurmSetting& setting, Results& results,
                  const std::function<std::size_t(std::size_t)>& missing) {
  Cluster(setting, results, missing).run();
}

}  // namespace quadrille::studies::explore
