/// Counters under the names that the profilers of real GPUs give them, where they count the same.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace quadrille::cli {

/// A counter of a profiler, and what it is here.
struct VendorCounter {
  std::string_view name;     ///< as the profiler shows it
  std::string_view ours;     ///< sums of counters over all units of a kind: "rop.written / frame.draws"
  std::string_view differs;  ///< what the two count otherwise; empty where nothing does
};
struct Profiler {
  std::string_view key;     ///< of --as
  std::string_view title;   ///< whose names they are
  std::string_view source;  ///< tag in docs/sources.md
  std::vector<VendorCounter> counters;
};

[[nodiscard]] const std::vector<Profiler>& profilers();
/// The words of --as: the keys, and "all".
[[nodiscard]] std::vector<std::string> profiler_words();
/// Tables of one profiler, or of all, as text or as a page of documentation.
[[nodiscard]] std::string vendor_table(std::string_view word, bool markdown);

}  // namespace quadrille::cli
