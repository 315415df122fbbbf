/// The results of a sweep: a file of SQLite to which each point is committed as it ends.
///
/// Whatever ends the program (Ctrl-C, `kill -9`, a power cut), what was committed stays, and what was not is
/// drawn again. One program at a time writes to a file; others may read it meanwhile. docs/explore.md has the
/// tables.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::studies::explore {

inline constexpr const char* kResultsSchema = "quadrille-explore-1";

/// A point: one machine draws one scene.
struct PointKey {
  std::string scene;        ///< hash of the command stream
  std::string machine;      ///< hash of all parameters
  std::int64_t window = 0;  ///< cycles; 0: exact
  // NOLINTNEXTLINE(modernize-use-nullptr)
  friend auto operator<=>(const PointKey&, const PointKey&) = default;
};

/// What is known of a point.
struct PointRow {
  PointKey key;
  std::string version;                ///< of the program that drew it
  std::string scene, machine;         ///< names
  std::vector<std::string> settings;  ///< what makes the machine from `machine`: "gpu.cores=8"
  std::string status;                 ///< "done", or how it ended
  std::string reason, log;            ///< of a point that is not done
  std::string picture;                ///< hash of its pixels
  std::string figures;                ///< lines PATH=NUMBER in alphabetical order
  double wall_s = 0, cpu_s = 0, simulate_s = 0, peak_rss_mib = 0;
  [[nodiscard]] bool done() const { return status == "done"; }
};

/// The figures of a point, by path. Lines that are none are passed over.
[[nodiscard]] std::map<std::string, double> figures_of(std::string_view lines);

/// About how many bytes of the file it takes, without its picture.
[[nodiscard]] double packed_bytes(const PointRow& row);

/// A transaction could not be written: the disk is full, say. Nothing of it was.
class ResultsNotWritten : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Results {
 public:
  /// Opens the file; makes one that is not there. Without a name the results are in memory alone. Throws
  /// `UserError` when it is no such file, or another program writes to it.
  explicit Results(const std::string& path);
  ~Results();
  Results(const Results&) = delete;
  Results& operator=(const Results&) = delete;

  /// Versions of the program that drew its points.
  [[nodiscard]] std::vector<std::string> versions() const;
  /// How each point ended.
  [[nodiscard]] std::map<PointKey, std::string> statuses() const;
  /// A point with all its figures.
  [[nodiscard]] std::optional<PointRow> load(const PointKey& key) const;
  [[nodiscard]] bool has_picture(const std::string& hash) const;
  /// A file of PNG; empty when there is none.
  [[nodiscard]] std::vector<std::byte> picture(const std::string& hash) const;
  /// Commits a point in place of what was known of it, and its picture if that is given. Throws
  /// `ResultsNotWritten`.
  void save(const PointRow& row, std::span<const std::byte> png);
  /// Takes over every point that is done in another file and not here. Throws `UserError`, and
  /// `ResultsNotWritten`. How many.
  std::size_t take_over(const std::string& path);

 private:
  struct Database;
  std::unique_ptr<Database> database_;
};

}  // namespace quadrille::studies::explore
