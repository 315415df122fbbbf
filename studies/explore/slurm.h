/// The backend beyond one machine: the points of a sweep as an array job of Slurm.
///
/// Each task of the array is this program with a part of the machines and a file of results of its own, in a
/// folder that the nodes share. What the parts have committed is taken over while they run; a task that ended
/// before its part was done is submitted again. A program that is started again goes on with the job that it
/// finds.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "studies/explore/results.h"

namespace quadrille::studies::explore {

struct SlurmSetting {
  std::string folder;                ///< of parts and logs; made when it is not there
  std::vector<std::string> command;  ///< this program with the sweep; the part and its results are added
  std::vector<std::string> options;  ///< for sbatch
  std::size_t parts = 1;
  int tries = 3;  ///< submissions of a part that gets no point further
  double seconds_between_looks = 2;
  std::function<void(const std::string&)> say = [](const std::string&) {};
};

/// Draws on the cluster until `missing` says that no part lacks a point, and takes over all points into the
/// results. `missing(part)`: how many points of a part the results do not have. Throws `UserError` when Slurm
/// refuses, or parts get no further.
void run_on_slurm(const SlurmSetting& setting, Results& results,
                  const std::function<std::size_t(std::size_t)>& missing);

/// The numbers as sbatch takes them: "0,3,4".
[[nodiscard]] std::string array_list(const std::vector<std::size_t>& parts);
/// The words as a shell reads them back.
[[nodiscard]] std::string shell_words(const std::vector<std::string>& words);

}  // namespace quadrille::studies::explore
