#include "studies/explore/results.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <unistd.h>
#include <zstd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "models/base/error.h"

namespace quadrille::studies::explore {
namespace {

constexpr int kLevel = 3;  // of zstd
constexpr std::size_t kMostFigureBytes = std::size_t{64} << 20;
// A program that was killed leaves its lock to the runs that it had started, for the moments in which they
// end.
constexpr int kLockTries = 50;
constexpr std::chrono::milliseconds kLockPause{100};

constexpr const char* kTables = R"(
CREATE TABLE IF NOT EXISTS about (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS pictures (hash TEXT PRIMARY KEY, png BLOB NOT NULL);
CREATE TABLE IF NOT EXISTS points (
  scene_hash TEXT NOT NULL, machine_hash TEXT NOT NULL, window_cycles INTEGER NOT NULL,
  version TEXT NOT NULL, scene TEXT NOT NULL, machine TEXT NOT NULL, settings TEXT NOT NULL,
  status TEXT NOT NULL, reason TEXT NOT NULL, log TEXT NOT NULL,
  cycles INTEGER, picture TEXT NOT NULL, figures BLOB NOT NULL,
  wall_s REAL NOT NULL, cpu_s REAL NOT NULL, simulate_s REAL NOT NULL, peak_rss_mib REAL NOT NULL,
  finished TEXT NOT NULL,
  PRIMARY KEY (scene_hash, machine_hash, window_cycles));
)";

constexpr const char* kColumns =
    "version, scene, machine, settings, status, reason, log, picture, figures, wall_s, cpu_s, simulate_s, "
    "peak_rss_mib";

std::string packed(const std::string& text) {
  std::string out(ZSTD_compressBound(text.size()), '\0');
  const std::size_t size = ZSTD_compress(out.data(), out.size(), text.data(), text.size(), kLevel);
  QUADRILLE_CHECK(ZSTD_isError(size) == 0, "{}", ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

/// Throws `UserError` that begins with `where`.
std::string unpacked(std::string_view bytes, const std::string& where) {
  if (bytes.empty()) return {};
  const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  std::string text(size > kMostFigureBytes ? 0 : size, '\0');
  const std::size_t got = ZSTD_decompress(text.data(), text.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(got) != 0) throw user_error("{}: the figures of a point are damaged", where);
  return text;
}

}  // namespace

std::map<std::string, double> figures_of(std::string_view lines) {
  std::map<std::string, double> figures;
  for (std::size_t at = 0; at < lines.size();) {
    const std::size_t end = std::min(lines.find('\n', at), lines.size()), equals = lines.find('=', at);
    double value = 0;
    if (equals < end &&
        std::from_chars(lines.data() + equals + 1, lines.data() + end, value).ec == std::errc{})
      figures.emplace_hint(figures.end(), lines.substr(at, equals - at), value);
    at = end + 1;
  }
  return figures;
}

double packed_bytes(const PointRow& row) {
  constexpr double kOthers = 400;  // names, hashes, numbers, and the index
  double bytes = kOthers + static_cast<double>(packed(row.figures).size());
  for (const std::string& setting : row.settings) bytes += static_cast<double>(setting.size() + 3);
  return bytes + static_cast<double>(row.reason.size() + row.log.size());
}

/// The connection, and the lock that keeps other writers out.
struct Results::Database {
  std::string path;
  sqlite3* handle = nullptr;
  int lock = -1;
  ~Database() {
    sqlite3_close(handle);
    if (lock >= 0) close(lock);  // after SQLite's own locks are gone: closing any file of it would end them
  }
  [[nodiscard]] UserError refused() const { return user_error("{}: {}", path, sqlite3_errmsg(handle)); }
  void run(const char* sql) const {
    if (sqlite3_exec(handle, sql, nullptr, nullptr, nullptr) != SQLITE_OK) throw refused();
  }
};

namespace {

/// A statement with its values bound in order.
class Statement {
 public:
  Statement(sqlite3* database, const std::string& sql) : database_(database) {
    failed_ = sqlite3_prepare_v2(database, sql.c_str(), -1, &handle_, nullptr) != SQLITE_OK;
  }
  ~Statement() { sqlite3_finalize(handle_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(const std::string& text) {
    failed_ |= sqlite3_bind_text(handle_, ++bound_, text.data(), static_cast<int>(text.size()),
                                 SQLITE_TRANSIENT) != SQLITE_OK;
    return *this;
  }
  Statement& bind(std::int64_t value) {
    failed_ |= sqlite3_bind_int64(handle_, ++bound_, value) != SQLITE_OK;
    return *this;
  }
  Statement& bind(double value) {
    failed_ |= sqlite3_bind_double(handle_, ++bound_, value) != SQLITE_OK;
    return *this;
  }
  Statement& bind_bytes(const void* data, std::size_t size) {
    failed_ |= sqlite3_bind_blob64(handle_, ++bound_, data, size, SQLITE_TRANSIENT) != SQLITE_OK;
    return *this;
  }
  Statement& bind(const PointKey& key) { return bind(key.scene).bind(key.machine).bind(key.window); }
  /// The next row; false at the end. Throws `UserError`.
  [[nodiscard]] bool next(const std::string& path) {
    const int code = failed_ ? SQLITE_ERROR : sqlite3_step(handle_);
    if (code == SQLITE_ROW) return true;
    if (code == SQLITE_DONE) return false;
    throw user_error("{}: {}", path, sqlite3_errmsg(database_));
  }
  /// Does it. Throws `ResultsNotWritten`.
  void run() {
    if (failed_ || sqlite3_step(handle_) != SQLITE_DONE) throw ResultsNotWritten(sqlite3_errmsg(database_));
  }
  [[nodiscard]] std::string text(int column) const {
    const auto* data = static_cast<const char*>(sqlite3_column_blob(handle_, column));
    return {data == nullptr ? "" : data, static_cast<std::size_t>(sqlite3_column_bytes(handle_, column))};
  }
  [[nodiscard]] double real(int column) const { return sqlite3_column_double(handle_, column); }
  [[nodiscard]] std::int64_t whole(int column) const { return sqlite3_column_int64(handle_, column); }

 private:
  sqlite3* database_;
  sqlite3_stmt* handle_ = nullptr;
  int bound_ = 0;
  bool failed_ = false;
};

int locked(const std::string& path) {
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) throw user_error("{}: {}", path, std::strerror(errno));
  for (int i = 0; i < kLockTries; ++i) {
    if (flock(file, LOCK_EX | LOCK_NB) == 0) return file;
    std::this_thread::sleep_for(kLockPause);
  }
  close(file);
  throw user_error("{}: another program is writing to it", path);
}

}  // namespace

Results::Results(const std::string& path) : database_(std::make_unique<Database>()) {
  Database& d = *database_;
  d.path = path;
  std::error_code unknown;
  if (std::filesystem::exists(path, unknown) && !std::filesystem::is_regular_file(path, unknown))
    throw user_error("{}: not a plain file", path);
  if (!path.empty()) d.lock = locked(path);
  if (sqlite3_open_v2(path.empty() ? ":memory:" : path.c_str(), &d.handle,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr) != SQLITE_OK)
    throw d.refused();
  sqlite3_busy_timeout(d.handle, 10'000);
  d.run("PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL;");
  d.run(kTables);
  Statement schema(d.handle, "SELECT value FROM about WHERE key = 'schema'");
  if (!schema.next(path)) {
    Statement insert(d.handle, "INSERT INTO about VALUES ('schema', ?)");
    try {
      insert.bind(std::string(kResultsSchema)).run();
    } catch (const ResultsNotWritten& e) { throw user_error("{}: {}", path, e.what()); }
  } else if (schema.text(0) != kResultsSchema) {
    throw user_error("{}: its schema is {}, not {}", path, schema.text(0), kResultsSchema);
  }
}

Results::~Results() = default;

std::vector<std::string> Results::versions() const {
  Statement select(database_->handle, "SELECT DISTINCT version FROM points ORDER BY version");
  std::vector<std::string> all;
  while (select.next(database_->path)) all.push_back(select.text(0));
  return all;
}

std::map<PointKey, std::string> Results::statuses() const {
  Statement select(database_->handle, "SELECT scene_hash, machine_hash, window_cycles, status FROM points");
  std::map<PointKey, std::string> all;
  while (select.next(database_->path))
    all[{select.text(0), select.text(1), select.whole(2)}] = select.text(3);
  return all;
}

std::optional<PointRow> Results::load(const PointKey& key) const {
  Statement select(database_->handle,
                   fmt::format("SELECT {} FROM points WHERE scene_hash = ? AND machine_hash = ? AND "
                               "window_cycles = ?",
                               kColumns));
  select.bind(key);
  if (!select.next(database_->path)) return std::nullopt;
  PointRow row;
  row.key = key;
  row.version = select.text(0);
  row.scene = select.text(1);
  row.machine = select.text(2);
  const auto settings = nlohmann::json::parse(select.text(3), nullptr, false);
  if (!settings.is_array()) throw user_error("{}: the settings of a point are damaged", database_->path);
  for (const auto& setting : settings)
    if (setting.is_string()) row.settings.push_back(setting.get<std::string>());
  row.status = select.text(4);
  row.reason = select.text(5);
  row.log = select.text(6);
  row.picture = select.text(7);
  row.figures = unpacked(select.text(8), database_->path);
  row.wall_s = select.real(9);
  row.cpu_s = select.real(10);
  row.simulate_s = select.real(11);
  row.peak_rss_mib = select.real(12);
  return row;
}

bool Results::has_picture(const std::string& hash) const {
  Statement select(database_->handle, "SELECT 1 FROM pictures WHERE hash = ?");
  return select.bind(hash).next(database_->path);
}

std::vector<std::byte> Results::picture(const std::string& hash) const {
  Statement select(database_->handle, "SELECT png FROM pictures WHERE hash = ?");
  if (!select.bind(hash).next(database_->path)) return {};
  const std::string png = select.text(0);
  const auto* data = reinterpret_cast<const std::byte*>(png.data());
  return {data, data + png.size()};
}

void Results::save(const PointRow& row, std::span<const std::byte> png) {
  sqlite3* const d = database_->handle;
  Statement(d, "BEGIN IMMEDIATE").run();
  try {
    if (!png.empty())
      Statement(d, "INSERT OR IGNORE INTO pictures VALUES (?, ?)")
          .bind(row.picture)
          .bind_bytes(png.data(), png.size())
          .run();
    const std::string figures = packed(row.figures);
    const std::map<std::string, double> known = figures_of(row.figures);
    const auto cycles = known.find("frame.cycles");
    Statement insert(
        d, fmt::format("INSERT OR REPLACE INTO points (scene_hash, machine_hash, window_cycles, {}, "
                       "cycles, finished) VALUES (?,?,?, ?,?,?,?,?,?,?,?,?,?,?,?,?, ?, "
                       "strftime('%Y-%m-%dT%H:%M:%fZ', 'now'))",
                       kColumns));
    insert.bind(row.key).bind(row.version).bind(row.scene).bind(row.machine);
    insert.bind(nlohmann::json(row.settings).dump()).bind(row.status).bind(row.reason).bind(row.log);
    insert.bind(row.picture).bind_bytes(figures.data(), figures.size());
    insert.bind(row.wall_s).bind(row.cpu_s).bind(row.simulate_s).bind(row.peak_rss_mib);
    if (cycles != known.end()) insert.bind(static_cast<std::int64_t>(cycles->second));
    insert.run();
    Statement(d, "COMMIT").run();
  } catch (const ResultsNotWritten&) {
    sqlite3_exec(d, "ROLLBACK", nullptr, nullptr, nullptr);
    throw;
  }
}

std::size_t Results::take_over(const std::string& path) {
  sqlite3* const d = database_->handle;
  // A file that is there and is read alone: another program may be writing to it.
  Statement attach(d, "ATTACH DATABASE ? AS other");
  if (attach.bind(path).next(path)) return 0;
  std::size_t taken = 0;
  try {
    Statement schema(d, "SELECT value FROM other.about WHERE key = 'schema'");
    if (!schema.next(path) || schema.text(0) != kResultsSchema)
      throw user_error("{}: its schema is not {}", path, kResultsSchema);
  } catch (const UserError&) {
    sqlite3_exec(d, "DETACH DATABASE other", nullptr, nullptr, nullptr);
    throw;
  }
  try {
    Statement(d, "BEGIN IMMEDIATE").run();
    Statement(d, "INSERT OR IGNORE INTO pictures SELECT * FROM other.pictures").run();
    Statement(d,
              "INSERT OR REPLACE INTO points SELECT o.* FROM other.points o LEFT JOIN points p USING "
              "(scene_hash, machine_hash, window_cycles) WHERE p.status IS NULL OR (p.status <> 'done' AND "
              "o.status = 'done')")
        .run();
    taken = static_cast<std::size_t>(sqlite3_changes(d));
    Statement(d, "COMMIT").run();
  } catch (const ResultsNotWritten&) {
    sqlite3_exec(d, "ROLLBACK; DETACH DATABASE other", nullptr, nullptr, nullptr);
    sqlite3_exec(d, "DETACH DATABASE other", nullptr, nullptr, nullptr);
    throw;
  }
  sqlite3_exec(d, "DETACH DATABASE other", nullptr, nullptr, nullptr);
  return taken;
}

}  // namespace quadrille::studies::explore
