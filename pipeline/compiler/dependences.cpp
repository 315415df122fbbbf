#include "pipeline/compiler/dependences.h"

#include <unordered_map>

namespace quadrille::pipeline {
namespace {

class Finder {
 public:
  Finder(std::span<const ScalarInstruction> code, const std::vector<bool>& variable)
      : code_(code),
        variable_(variable),
        needs_(code.size()),
        last_output_(code.size()),
        last_write_(code.size()) {}

  std::vector<std::vector<std::size_t>> run() {
    for (std::size_t at = 0; at < code_.size(); ++at) {
      read(at);
      if (code_[at].op == models::Op::kOutput) {
        if (last_output_ < code_.size()) needs_[at].push_back(last_output_);
        last_output_ = at;
      }
      access(at);
      for (int k = 0; k < models::destination_count(code_[at].op); ++k)
        write(at, code_[at].dst + static_cast<std::uint32_t>(k));
    }
    return std::move(needs_);
  }

 private:
  /// Buffers may overlap, so all accesses that could meet stay in their order.
  void access(std::size_t at) {
    const models::Op op = code_[at].op;
    const bool writes = models::writes_buffer(op);
    if (!writes && op != models::Op::kLoadBuffer) return;
    if (last_write_ < code_.size()) needs_[at].push_back(last_write_);
    if (!writes) {
      loads_.push_back(at);
      return;
    }
    needs_[at].insert(needs_[at].end(), loads_.begin(), loads_.end());
    loads_.clear();
    last_write_ = at;
  }

  void read(std::size_t at) {
    for (const Value& v : {code_[at].a, code_[at].b, code_[at].c}) {
      if (!v.is_register()) continue;
      if (const auto made = writer_.find(v.bits); made != writer_.end()) needs_[at].push_back(made->second);
      if (variable_[v.bits]) readers_[v.bits].push_back(at);
    }
  }

  void write(std::size_t at, std::uint32_t target) {
    if (variable_[target]) {
      if (const auto made = writer_.find(target); made != writer_.end()) needs_[at].push_back(made->second);
      for (const std::size_t reader : readers_[target])
        if (reader != at) needs_[at].push_back(reader);
      readers_[target].clear();
    }
    writer_[target] = at;
  }

  std::span<const ScalarInstruction> code_;
  const std::vector<bool>& variable_;
  std::vector<std::vector<std::size_t>> needs_;
  std::unordered_map<std::uint32_t, std::size_t> writer_;
  std::unordered_map<std::uint32_t, std::vector<std::size_t>> readers_;
  std::size_t last_output_, last_write_;
  std::vector<std::size_t> loads_;  ///< of buffers, since the last write
};

}  // namespace

std::vector<std::vector<std::size_t>> dependences(std::span<const ScalarInstruction> code,
                                                  const std::vector<bool>& variable) {
  return Finder(code, variable).run();
}

}  // namespace quadrille::pipeline
