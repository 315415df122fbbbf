/// Files and folders that this process is making and would leave behind if a signal ended it now: they are
/// removed on the way out.
///
/// A file appears whole, by a rename (`write_whole_file`); until then it has a name of its own, which errors
/// and exceptions remove. Signals pass those by: Ctrl-C, a closed terminal, `kill`, a limit of processor
/// time, an abort. Every one that can be caught removes what is listed here, then does what it would have
/// done.
#pragma once

#include <cstddef>
#include <string>

namespace quadrille::traces {

/// Lists a path for as long as it lives; the latest is removed first. Removing it in time is its owner's
/// business. Few at a time: one more than there is room for is not listed.
class Unfinished {
 public:
  explicit Unfinished(const std::string& path);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

 private:
  std::size_t place_;
};

/// From now on signals that end the process remove what is listed. Signals that are ignored or have a handler
/// already are left alone. A fork inherits it.
void remove_unfinished_at_signals();

}  // namespace quadrille::traces
