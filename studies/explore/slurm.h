/// The backend beyond one machine: the points of a sweep as an array job of Slurm.
///
/// Each task of the array is this program with a list of points and a file of results of its own, in a folder
/// that the nodes share. What a task has committed is taken over when it has ended, however it did; points
/// that lack then are submitted again. A program that is started again goes on with the job that it finds.
#pragma once

#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "studies/explore/results.h"

namespace quadrille::studies::explore {

struct SlurmSetting {
  std::string folder;                ///< of lists, results and logs; made when it is not there
  std::vector<std::string> command;  ///< this program with the sweep; the list and the results are added
  std::vector<std::string> options;  ///< for sbatch
  bool jobs_of_node = true;          ///< as many points at a time as Slurm gives a task cores
  std::size_t parts = 1;             ///< tasks of the array, at most
  int tries = 3;                     ///< submissions in a row that get no point further
  double seconds_between_looks = 2;
  std::function<void(const std::string&)> say = [](const std::string&) {};
};

/// Draws on the cluster until `missing` says that no point lacks, and takes all over into the results.
/// `missing()`: the points that the results do not have. Throws `UserError` when Slurm refuses, or points get
/// no further.
void run_on_slurm(const SlurmSetting& setting, Results& results,
                  const std::function<std::vector<PointKey>()>& missing);

/// A list of points as a file has it, a line each, and back. Throws `UserError` that begins with `file`.
[[nodiscard]] std::string point_list(const std::vector<PointKey>& points);
[[nodiscard]] std::set<PointKey> read_point_list(std::string_view text, const std::string& file);

/// The words as a shell reads them back.
[[nodiscard]] std::string shell_words(const std::vector<std::string>& words);

}  // namespace quadrille::studies::explore
