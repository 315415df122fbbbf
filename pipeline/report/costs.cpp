#include "pipeline/report/costs.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "models/base/near_name.h"
#include "pipeline/machine/config_files.h"
#include "pipeline/machine/counter_catalogue.h"
#include "traces/whole_file.h"

namespace quadrille::pipeline {

namespace {

namespace fs = std::filesystem;

constexpr double kMost = 1e12;  // of any number: far from where sums of doubles end
constexpr std::string_view kSram = "sram";
const std::string kEnergyUnit = "pJ", kAreaUnit = "um2";

/// A table of the file, which says where it stands when something is wrong with it.
class Entry {
 public:
  Entry(const toml::table& table, std::string file, std::string name)
      : table_(table), file_(std::move(file)), name_(std::move(name)) {}

  [[nodiscard]] std::string where(const toml::node* node = nullptr) const {
    return fmt::format("{}:{}", file_, (node != nullptr ? *node : table_).source().begin.line);
  }
  [[nodiscard]] UserError wrong(std::string_view key, std::string_view what) const {
    return user_error("{}: {}.{}: {}", where(table_.get(key)), name_, key, what);
  }
  /// Throws for a key that is none of these.
  void check_keys(const std::vector<std::string>& keys) const {
    for (const auto& [key, node] : table_) {
      const std::string name(key.str());
      if (std::ranges::find(keys, name) == keys.end())
        throw user_error("{}: unknown key '{}' in {}; there are {}{}", where(&node), name, name_,
                         fmt::join(keys, ", "), did_you_mean(name, keys));
    }
  }
  [[nodiscard]] bool has(std::string_view key) const { return table_.get(key) != nullptr; }
  [[nodiscard]] std::string text(std::string_view key) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr || !node->is_string()) throw wrong(key, "a text in quotes is expected");
    return node->as_string()->get();
  }
  [[nodiscard]] double number(std::string_view key) const { return number(key, table_.get(key)); }
  [[nodiscard]] Range range() const {
    const Range r{number("low"), number("typical"), number("high")};
    if (r.low > r.typical || r.typical > r.high)
      throw wrong("typical", fmt::format("low <= typical <= high is expected, not {}, {}, {}", r.low,
                                         r.typical, r.high));
    return r;
  }
  /// A product of numbers and of parameters of the machine: ["texture.cache_lines", 128].
  [[nodiscard]] double product(std::string_view key, const MachineConfig& machine) const {
    const toml::node* node = table_.get(key);
    const toml::array* factors = node != nullptr ? node->as_array() : nullptr;
    if (factors == nullptr || factors->empty())
      throw wrong(key, "a list of numbers and of parameters in quotes is expected, which are multiplied");
    double product = 1;
    for (const toml::node& factor : *factors)
      product *=
          factor.is_string() ? parameter(key, factor.as_string()->get(), machine) : number(key, &factor);
    if (product > kMost)
      throw wrong(key, fmt::format("the product is {:g}; at most {:g} is read", product, kMost));
    return product;
  }
  /// The text with the machine's word in the place of a parameter in braces: "dram_{memory.kind}".
  [[nodiscard]] std::string word(std::string_view key, const MachineConfig& machine) const {
    std::string given = text(key);
    const std::size_t open = given.find('{'), close = given.find('}');
    if (open == std::string::npos) return given;
    const hw::ParamBase* p = close == std::string::npos || close < open
                                 ? nullptr
                                 : machine.find(given.substr(open + 1, close - open - 1));
    if (p == nullptr || !p->is_word())
      throw wrong(key, fmt::format("'{}': a parameter that is a word is expected between the braces", given));
    return given.substr(0, open) + p->value_text() + given.substr(close + 1);
  }

 private:
  [[nodiscard]] double number(std::string_view key, const toml::node* node) const {
    const auto value = node != nullptr && node->is_number() ? node->value<double>() : std::nullopt;
    if (!value || !(*value >= 0 && *value <= kMost))
      throw wrong(key, fmt::format("a number of 0 to {:g} is expected", kMost));
    return *value;
  }
  [[nodiscard]] double parameter(std::string_view key, const std::string& path,
                                 const MachineConfig& machine) const {
    const hw::ParamBase* p = machine.find(path);
    if (p == nullptr)
      throw wrong(key,
                  fmt::format("no parameter is called '{}'{}", path, did_you_mean(path, machine.paths())));
    if (!p->words().empty()) throw wrong(key, fmt::format("{} is no number", path));
    return std::stod(p->value_text());
  }

  const toml::table& table_;
  std::string file_, name_;
};

/// A size of memory of which the file says what an access of 64 bits costs.
struct SramSize {
  double bytes = 0;
  Range access;
};

/// A straight line between the logarithms of two sizes and of their costs, on which other sizes lie too.
double on_line(double bytes, double bytes_a, double cost_a, double bytes_b, double cost_b) {
  if (cost_a <= 0 || cost_b <= 0) return std::max(cost_a, cost_b);
  const double slope = std::log(cost_b / cost_a) / std::log(bytes_b / bytes_a);
  return cost_a * std::pow(bytes / bytes_a, slope);
}

/// An access of 64 bits to an array of so many bytes: between the sizes that are known, and beyond them by
/// the nearest two.
Range sram_access(const std::vector<SramSize>& sizes, double bytes) {
  if (sizes.size() == 1) return sizes.front().access;
  std::size_t b = 1;
  while (b + 1 < sizes.size() && sizes[b].bytes < bytes) ++b;
  const SramSize& lower = sizes[b - 1];
  const SramSize& upper = sizes[b];
  const auto at = [&](double Range::*part) {
    return on_line(bytes, lower.bytes, lower.access.*part, upper.bytes, upper.access.*part);
  };
  Range r{at(&Range::low), at(&Range::typical), at(&Range::high)};
  r.low = std::min(r.low, r.typical);  // lines of other slopes may cross beyond the known sizes
  r.high = std::max(r.high, r.typical);
  return r;
}

/// Everything in the file, worked out for a machine.
class Reader {
 public:
  Reader(const toml::table& root, const std::string& file, const MachineConfig& machine)
      : root_(root), file_(file), machine_(machine) {
    costs_.name = file;
  }

  CostFile read() {
    const Entry root(root_, file_, "the file");
    root.check_keys({"constants", "sram", "event", "area"});
    if (const toml::node* node = root_.get("constants")) {
      if (!node->is_table()) throw root.wrong("constants", "a table is expected, as in [constants.fp32_add]");
      for (const auto& [name, constant] : *node->as_table()) {
        const std::string key = "constants." + std::string(name.str());
        if (!constant.is_table()) throw root.wrong("constants", fmt::format("{} is no table", key));
        read_constant(Entry(*constant.as_table(), file_, key), std::string(name.str()));
      }
    }
    each("sram", [this](const Entry& entry) { read_size(entry); });
    each("event", [this](const Entry& entry) { read_event(entry); });
    each("area", [this](const Entry& entry) { read_area(entry); });
    std::erase_if(costs_.constants,
                  [this](const CostConstant& c) { return std::ranges::find(used_, c.name) == used_.end(); });
    return std::move(costs_);
  }

 private:
  template <class Read>
  void each(const std::string& key, const Read& read) const {
    const toml::node* node = root_.get(key);
    if (node == nullptr) return;
    const toml::array* entries = node->as_array();
    std::size_t number = 0;
    for (std::size_t i = 0; entries != nullptr && i < entries->size(); ++i) {
      const toml::table* table = entries->get(i)->as_table();
      if (table == nullptr) break;
      read(Entry(*table, file_, fmt::format("{}[{}]", key, number++)));
    }
    if (entries == nullptr || number < entries->size())
      throw user_error("{}:{}: {}: tables are expected, each begun by [[{}]]", file_,
                       node->source().begin.line, key, key);
  }

  void read_constant(const Entry& entry, const std::string& name) {
    entry.check_keys({"low", "typical", "high", "unit", "source"});
    const std::string unit = entry.text("unit");
    if (unit != kEnergyUnit && unit != kAreaUnit)
      throw entry.wrong("unit", fmt::format("'{}' is neither {} nor {}", unit, kEnergyUnit, kAreaUnit));
    if (name == kSram) throw user_error("{}: [[sram]] gives that by size", entry.where());
    costs_.constants.push_back({name, unit, entry.text("source"), entry.range()});
  }

  void read_size(const Entry& entry) {
    entry.check_keys({"kib", "low", "typical", "high", "source"});
    const double bytes = 1024 * entry.number("kib");
    if (bytes <= (sizes_.empty() ? 0 : sizes_.back().bytes))
      throw entry.wrong("kib", "sizes are expected from the smallest to the largest");
    sizes_.push_back({bytes, entry.range()});
    costs_.constants.push_back({fmt::format("sram_{:g}_kib", bytes / 1024), kEnergyUnit, entry.text("source"),
                                sizes_.back().access});
  }

  void check_unit(const Entry& entry, const std::string& kind) const {
    constexpr auto kKinds = unit_kind_names();
    const std::vector<std::string> kinds(kKinds.begin(), kKinds.end());
    if (std::ranges::find(kinds, kind) == kinds.end())
      throw entry.wrong("unit",
                        fmt::format("no unit is called '{}'; there are {}", kind, fmt::join(kinds, ", ")));
  }

  void check_counter(const Entry& entry, const Cost& cost) const {
    std::vector<std::string> names;
    for (const UnitCounters& unit : counters_)
      if (unit.kind == cost.unit)
        for (const hw::Counter* c : unit.stats->counters()) names.emplace_back(c->name());
    if (std::ranges::find(names, cost.counter) == names.end())
      throw entry.wrong("counter",
                        fmt::format("{} has no counter '{}'; quadrille describe {} lists them{}", cost.unit,
                                    cost.counter, cost.unit, did_you_mean(cost.counter, names)));
  }

  /// The value of the constant, which is of this unit of measure.
  Range constant(const Entry& entry, const std::string& name, const std::string& unit) {
    std::vector<std::string> names;
    for (const CostConstant& c : costs_.constants) {
      if (c.unit == unit) names.push_back(c.name);
      if (c.unit != unit || c.name != name) continue;
      used_.push_back(name);
      return c.value;
    }
    throw entry.wrong("cost", fmt::format("no constant in {} is called '{}'; there are {}", unit, name,
                                          fmt::join(names, ", ")));
  }

  void read_event(const Entry& entry) {
    entry.check_keys({"unit", "counter", "times", "cost", "bytes", "what"});
    Cost cost{entry.text("unit"), entry.text("counter"), entry.text("what"), entry.word("cost", machine_),
              entry.has("times") ? entry.number("times") : 1};
    check_unit(entry, cost.unit);
    check_counter(entry, cost);
    if (entry.has("bytes") != (cost.constant == kSram))
      throw entry.wrong("bytes", "goes with cost = \"sram\", and says how large the array is");
    if (cost.constant == kSram) {
      cost.bytes = entry.product("bytes", machine_);
      if (sizes_.empty()) throw entry.wrong("cost", "the file has no [[sram]]");
      if (cost.bytes <= 0) throw entry.wrong("bytes", "an array of no bytes");
      cost.each = sram_access(sizes_, cost.bytes) * cost.times;
      if (!(cost.each.high <= kMost * kMost))
        throw entry.wrong("bytes",
                          "the costs of [[sram]] rise without measure towards an array of that size");
      for (const CostConstant& c : costs_.constants)
        if (c.name.starts_with("sram_")) used_.push_back(c.name);
    } else {
      cost.each = constant(entry, cost.constant, kEnergyUnit) * cost.times;
    }
    costs_.events.push_back(std::move(cost));
  }

  void read_area(const Entry& entry) {
    entry.check_keys({"unit", "count", "cost", "what"});
    Cost cost{entry.text("unit"), "", entry.text("what"), entry.text("cost"),
              entry.product("count", machine_)};
    check_unit(entry, cost.unit);
    cost.each = constant(entry, cost.constant, kAreaUnit) * cost.times;
    costs_.areas.push_back(std::move(cost));
  }

  const toml::table& root_;
  const std::string& file_;
  const MachineConfig& machine_;
  std::vector<UnitCounters> counters_ = counter_catalogue();
  std::vector<SramSize> sizes_;
  std::vector<std::string> used_;  ///< names of constants
  CostFile costs_;
};

/// The file of that name that comes with the program.
std::string file_of_costs(const std::string& name) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::path& folder : config_folders()) {
    const fs::path file = folder / "energy" / (name + ".toml");
    if (!name.empty() && name.find('/') == std::string::npos && fs::exists(file, error)) return file.string();
    for (const auto& entry : fs::directory_iterator(folder / "energy", error))
      if (names.empty() || names.back() != entry.path().stem()) names.push_back(entry.path().stem().string());
  }
  throw user_error("--energy: '{}' is unknown; there are {}; or give a path that ends in .toml", name,
                   fmt::join(names, ", "));
}

}  // namespace

CostFile read_costs(std::string_view text, const std::string& file, const MachineConfig& machine) {
  check_config_lines(text, file);
  try {
    const toml::table root = toml::parse(text, file);
    return Reader(root, file, machine).read();
  } catch (const toml::parse_error& e) {
    throw user_error("{}:{}: {}", file, e.source().begin.line, e.description());
  }
}

CostFile load_costs(const std::string& name_or_path, const MachineConfig& machine) {
  const bool is_path = fs::path(name_or_path).extension() == ".toml";
  const std::string path = is_path ? name_or_path : file_of_costs(name_or_path);
  const std::vector<std::byte> bytes = traces::read_whole_file(path, kMaxConfigBytes);
  CostFile costs = read_costs({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, machine);
  costs.name = name_or_path;
  return costs;
}

}  // namespace quadrille::pipeline
