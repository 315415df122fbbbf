#include "studies/explore/slurm.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <span>
#include <sstream>
#include <thread>

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
  while (const std::size_t got = std::fread(part.data(), 1, part.size(), pipe))
    answer.text.append(part.data(), got);
  const int status = pclose(pipe);
  answer.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  while (answer.text.ends_with('\n')) answer.text.pop_back();
  return answer;
}

void write_text(const std::string& path, const std::string& text) {
  traces::write_whole_file(path, std::as_bytes(std::span(text)));
}

class Cluster {
 public:
  Cluster(const SlurmSetting& setting, Results& results,
          const std::function<std::vector<PointKey>()>& missing)
      : setting_(setting), results_(results), missing_(missing) {}

  void run() {
    fs::create_directories(setting_.folder);
    if (const std::string job = earlier_job(); !job.empty()) wait(job);
    collect({});
    std::vector<PointKey> points = missing_();
    for (int tries = 0; !points.empty();) {
      wait(submit(points));
      const std::size_t before = points.size();
      points = missing_();
      tries = points.size() < before ? 0 : tries + 1;
      if (!points.empty() && tries >= setting_.tries)
        throw user_error("{}: {} points got no further in {} submissions; part-*.log there say why",
                         setting_.folder, points.size(), tries);
    }
    fs::remove(job_file());
  }

 private:
  [[nodiscard]] std::string job_file() const { return (fs::path(setting_.folder) / "job").string(); }
  [[nodiscard]] std::string part_file(std::size_t part, const char* ending) const {
    return (fs::path(setting_.folder) / fmt::format("part-{}{}", part, ending)).string();
  }
  /// The job of a program that was ended while it waited; none when Slurm does not know it any more.
  [[nodiscard]] std::string earlier_job() const {
    std::ifstream file(job_file());
    std::string job;
    if (!std::getline(file, job) || job.empty() || queued_parts(job).empty()) return {};
    setting_.say(fmt::format("goes on with job {}", job));
    return job;
  }
  /// The tasks of a job that wait or run.
  [[nodiscard]] static std::set<std::size_t> queued_parts(const std::string& job) {
    const Answer answer = ask({"squeue", "--noheader", "--array", "--jobs", job, "--format", "%K"});
    std::set<std::size_t> parts;
    if (answer.code != 0) return parts;
    std::istringstream lines(answer.text);
    for (std::size_t part = 0; lines >> part;) parts.insert(part);
    return parts;
  }
  /// $SLURM_ARRAY_TASK_ID is the part; a shell of the node puts it in.
  [[nodiscard]] std::string script() const {
    const std::string part = shell_words({setting_.folder}) + "/part-\"$SLURM_ARRAY_TASK_ID\"";
    return fmt::format("#!/bin/sh\nexec {} {}--only {}.points --out {}.db\n", shell_words(setting_.command),
                       setting_.jobs_of_node ? "--jobs \"${SLURM_CPUS_ON_NODE:-1}\" " : "", part, part);
  }
  [[nodiscard]] std::string submit(const std::vector<PointKey>& points) const {
    const std::size_t parts = std::min(setting_.parts, points.size());
    for (std::size_t part = 0; part < parts; ++part) {
      std::vector<PointKey> own;
      for (std::size_t i = part; i < points.size(); i += parts) own.push_back(points[i]);
      write_text(part_file(part, ".points"), point_list(own));
      for (const char* ending : {".db", ".db-wal", ".db-shm"}) fs::remove(part_file(part, ending));
    }
    const std::string path = (fs::path(setting_.folder) / "task.sh").string();
    write_text(path, script());
    std::vector<std::string> words{"sbatch", "--parsable", fmt::format("--array=0-{}", parts - 1),
                                   "--output=" + (fs::path(setting_.folder) / "part-%a.log").string(),
                                   "--chdir=" + fs::current_path().string()};
    words.insert(words.end(), setting_.options.begin(), setting_.options.end());
    words.push_back(path);
    const Answer answer = ask(words);
    if (answer.code != 0) throw user_error("sbatch: {}", answer.text);
    std::string job = answer.text.substr(0, answer.text.find(';'));  // a cluster's name may follow
    write_text(job_file(), job);
    setting_.say(fmt::format("job {} draws {} points in {} parts", job, points.size(), parts));
    return job;
  }
  /// Until no task of the job is left; what those that end have drawn is taken over at once.
  void wait(const std::string& job) {
    for (std::set<std::size_t> parts = queued_parts(job); !parts.empty();) {
      std::this_thread::sleep_for(std::chrono::duration<double>(setting_.seconds_between_looks));
      const std::set<std::size_t> now = queued_parts(job);
      if (now == parts) continue;
      parts = now;
      collect(parts);
      setting_.say(fmt::format("job {}: {} parts and {} points to go", job, parts.size(), missing_().size()));
    }
    collect({});
  }
  /// Takes over the results of all parts but those that still run: a file of SQLite that is written on
  /// another host cannot be read meanwhile.
  void collect(const std::set<std::size_t>& running) {
    for (std::size_t part = 0; fs::exists(part_file(part, ".points")); ++part) {
      const std::string file = part_file(part, ".db");
      if (running.contains(part) || !fs::exists(file)) continue;
      try {
        (void)results_.take_over(file);
      } catch (const UserError&) {  // its task was ended before it made the tables
      } catch (const ResultsNotWritten& error) {
        throw user_error("the results cannot be written: {}", error.what());
      }
    }
  }

  const SlurmSetting& setting_;
  Results& results_;
  const std::function<std::vector<PointKey>()>& missing_;
};

}  // namespace

std::string point_list(const std::vector<PointKey>& points) {
  std::string text;
  for (const PointKey& point : points)
    text += fmt::format("{} {} {}\n", point.scene, point.machine, point.window);
  return text;
}

std::set<PointKey> read_point_list(std::string_view text, const std::string& file) {
  std::set<PointKey> points;
  std::istringstream lines{std::string(text)};
  std::size_t number = 1;
  for (std::string line; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    PointKey point;
    if (!(words >> point.scene >> point.machine >> point.window))
      throw user_error("{}:{}: hash of the scene, hash of the machine and window are expected", file, number);
    points.insert(std::move(point));
  }
  return points;
}

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
                  const std::function<std::vector<PointKey>()>& missing) {
  Cluster(setting, results, missing).run();
}

}  // namespace quadrille::studies::explore
