/// Keeps, while a machine runs, what moved in each slice of the frame; afterwards, the figures of that.
///
/// Every unit is asked for its numbers when it comes to the end of a slice, before it acts (hw/base/
/// resource.h): a client of the L2 cache for its bytes, a memory channel for those of its clients, and all of
/// them for what they pushed into their outputs and popped from their inputs. Only a unit itself changes
/// these numbers, so they are right for that moment even where its neighbours are simulated ahead of it.
#pragma once

#include "pipeline/machine/machine.h"
#include "pipeline/report/figures.h"

#include <functional>
#include <memory>
#include <vector>

namespace quadrille::pipeline {

class FlowLog {
 public:
  /// Before the run. The machine is not run any more once this is gone.
  explicit FlowLog(const Machine& machine);
  ~FlowLog();
  FlowLog(const FlowLog&) = delete;
  FlowLog& operator=(const FlowLog&) = delete;

  /// After the run: adds `flow` to the machine's figures, and the laws that its slices obey.
  void collect(Figures& figures) const;

 private:
  class Watched;
  const Machine& machine_;
  std::vector<std::unique_ptr<Watched>> units_;
};

}  // namespace quadrille::pipeline
