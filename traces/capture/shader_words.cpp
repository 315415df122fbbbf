/// Instructions are copied one by one; what is added stands before the functions and behind them.
#include "traces/capture/shader_words.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>

#include "models/base/error.h"
#include "traces/capture/spirv_parts.h"

namespace quadrille::capture {
namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t kMaxBound = 1u << 22;  // [SPIRV §2.17: 0x3FFFFF]
constexpr std::uint32_t kPosition = 0, kOutput = 3, kDemoteCapability = 5379, kBaseInstance = 4425,
                        kHalf = 0x3f000000;

/// The words of a string from `first` on.
std::string text_of(Instruction i, std::size_t first) {
  std::string text;
  for (std::size_t w = first; w < i.size(); ++w) {
    for (int byte = 0; byte < 4; ++byte) {
      const char c = static_cast<char>(i[w] >> (8 * byte) & 0xff);
      if (c == 0) return text;
      text += c;
    }
  }
  throw user_error("a name in a shader has no end");
}
std::size_t text_words(const std::string& text) { return text.size() / 4 + 1; }

void append(Words& words, std::uint32_t op, std::initializer_list<std::uint32_t> operands) {
  words.push_back(static_cast<std::uint32_t>(operands.size() + 1) << 16 | op);
  words.insert(words.end(), operands);
}

/// What has to be known before anything is written.
struct Facts {
  std::uint32_t entry = 0, function_type = 0, void_type = 0;
  std::map<std::uint32_t, std::uint32_t> spec_numbers;  ///< by the constant's id
  std::uint32_t position = 0;  ///< the variable, or the one of the block that it is a member of
  std::optional<std::uint32_t> member;
  std::uint32_t block = 0;  ///< the structure that has it as a member
  std::uint32_t float_type = 0, vector_type = 0, pointer_type = 0, int_type = 0;
  std::uint32_t first_instance = 0, first_instance_type = 0;  ///< the variable, and what is loaded of it
  std::set<std::uint32_t> outputs;                            ///< variables
};

bool is_first_instance(Instruction i) {
  return op_of(i) == kDecorate && i.size() == 4 && i[2] == kBuiltIn && i[3] == kBaseInstance;
}

class Module {
 public:
  Module(std::span<const std::uint32_t> words, const ShaderWish& wish)
      : words_(words), wish_(wish), instructions_(split(words)) {
    gather();
  }

  Words rewritten() {
    Words out(words_.begin(), words_.begin() + kSpirvHeader);
    bound_ = words_[kSpirvBound];
    if (demotes_ && !may_demote_) allow_demotion(out);
    const bool moves = wish_.negative_one_to_one && facts_.position != 0;
    const std::uint32_t main = moves ? bound_++ : facts_.entry;
    bool before_functions = true;
    for (const Instruction i : instructions_) {
      if (before_functions && op_of(i) == kFunction) {
        if (moves) declare(out);
        declare_first_instance(out);
      }
      before_functions = before_functions && op_of(i) != kFunction;
      copy(out, i, main);
    }
    if (moves) add_main(out, main);
    out[kSpirvBound] = bound_;
    return out;
  }

 private:
  [[nodiscard]] bool is_entry(Instruction i) const {
    return i.size() > 3 && i[1] == (wish_.stage == traces::ShaderStage::kVertex ? 0u : 4u) &&
           text_of(i, 3) == wish_.entry;
  }

  void gather() {
    for (const Instruction i : instructions_)
      if (op_of(i) == kEntryPoint && is_entry(i)) facts_.entry = i[2];
    if (facts_.entry == 0) throw user_error("a shader module has no entry point '{}'", wish_.entry);
    for (const Instruction i : instructions_) gather(i);
    for (const Instruction i : instructions_) find_position(i);
    for (const Instruction i : instructions_)
      if (is_load_of_first_instance(i)) facts_.first_instance_type = i[1];
  }
  [[nodiscard]] bool is_load_of_first_instance(Instruction i) const {
    return facts_.first_instance != 0 && op_of(i) == kLoad && i.size() >= 4 && i[3] == facts_.first_instance;
  }
  /// Its name, decorations and declaration, which go.
  [[nodiscard]] bool is_about_first_instance(Instruction i) const {
    const std::uint32_t op = op_of(i);
    if (facts_.first_instance == 0 || i.size() < 3) return false;
    return ((op == kName || op == kDecorate) && i[1] == facts_.first_instance) ||
           (op == kVariable && i[2] == facts_.first_instance);
  }
  void gather(Instruction i) {
    const std::uint32_t op = op_of(i);
    if (op == kFunction && i.size() == 5 && i[2] == facts_.entry) {
      facts_.void_type = i[1];
      facts_.function_type = i[4];
    }
    if (op == kDecorate && i.size() == 4 && i[2] == kSpecId) facts_.spec_numbers[i[1]] = i[3];
    if (op == kDecorate && i.size() == 4 && i[2] == kBuiltIn && i[3] == kPosition) facts_.position = i[1];
    if (op == kVariable && i.size() >= 4 && i[3] == kOutput) gather_output(i);
    if (op == kTypeArray && i.size() == 4) arrays_.insert(i[1]);
    demotes_ = demotes_ || op == kDemote;
    if (op == kCapability && i.size() == 2 && i[1] == kDemoteCapability) may_demote_ = true;
    if (is_first_instance(i)) facts_.first_instance = i[1];
    if (op == kMemberDecorate && i.size() == 5 && i[3] == kBuiltIn && i[4] == kPosition) {
      facts_.block = i[1];
      facts_.member = i[2];
    }
    if (op == kTypeFloat && i.size() >= 3 && i[2] == 32) facts_.float_type = i[1];
    if (op == kTypeInt && i.size() == 4 && i[2] == 32) facts_.int_type = i[1];
    if (op == kTypeVector && i.size() == 4 && i[2] == facts_.float_type && i[3] == 4)
      facts_.vector_type = i[1];
    if (op == kTypePointer && i.size() == 4 && i[2] == kOutput) {
      if (i[3] == facts_.vector_type) facts_.pointer_type = i[1];
      if (facts_.block != 0 && i[3] == facts_.block) block_pointer_ = i[1];
      if (arrays_.contains(i[3])) arrays_.insert(i[1]);
    }
  }
  void gather_output(Instruction i) {
    facts_.outputs.insert(i[2]);
    if (!wish_.outputs.empty() && arrays_.contains(i[1]))
      throw user_error("an array of outputs where a pass leaves out colour attachments is not supported");
  }
  void find_position(Instruction i) {
    if (block_pointer_ != 0 && op_of(i) == kVariable && i.size() >= 4 && i[1] == block_pointer_)
      facts_.position = i[2];
  }

  void copy(Words& out, Instruction i, std::uint32_t main) {
    const std::uint32_t op = op_of(i);
    if (op == kEntryPoint) {
      if (is_entry(i)) copy_entry(out, i, main);
    } else if (op == kExecutionMode) {
      if (i.size() > 2 && i[1] == facts_.entry) {
        out.insert(out.end(), i.begin(), i.end());
        out[out.size() - i.size() + 1] = main;
      }
    } else if (op == kSpecTrue || op == kSpecFalse || op == kSpecConstant) {
      copy_constant(out, i);
    } else if (moved_output(i) != nullptr) {
      append(out, kDecorate, {i[1], kLocation, *moved_output(i)});
    } else if (is_load_of_first_instance(i)) {
      append(out, kCopyObject, {i[1], i[2], first_instance_});
    } else if (!is_about_first_instance(i)) {
      out.insert(out.end(), i.begin(), i.end());
    }
  }
  /// Of a decoration with the location of an output: where that goes; null if it stays.
  [[nodiscard]] const std::uint32_t* moved_output(Instruction i) const {
    if (wish_.outputs.empty() || op_of(i) != kDecorate || i.size() != 4 || i[2] != kLocation) return nullptr;
    const auto place = wish_.outputs.find(i[3]);
    return place == wish_.outputs.end() || !facts_.outputs.contains(i[1]) ? nullptr : &place->second;
  }
  void copy_entry(Words& out, Instruction i, std::uint32_t main) {
    const Instruction all = i.subspan(3 + text_words(wish_.entry));
    Words interface(all.begin(), all.end());
    std::erase(interface, facts_.first_instance);
    out.push_back(static_cast<std::uint32_t>(5 + interface.size()) << 16 | kEntryPoint);
    out.push_back(i[1]);
    out.push_back(main);
    out.push_back(0x6e69616d);  // "main"
    out.push_back(0);
    out.insert(out.end(), interface.begin(), interface.end());
  }
  void copy_constant(Words& out, Instruction i) {
    const std::size_t at = out.size();
    out.insert(out.end(), i.begin(), i.end());
    if (i.size() < 3) return;
    const auto number = facts_.spec_numbers.find(i[2]);
    if (number == facts_.spec_numbers.end()) return;
    const auto value = wish_.constants.find(number->second);
    if (value == wish_.constants.end()) return;
    if (op_of(i) == kSpecConstant && i.size() == 4) out[at + 3] = value->second;
    else if (op_of(i) != kSpecConstant)
      out[at] = (out[at] & ~0xffffu) | (value->second != 0 ? kSpecTrue : kSpecFalse);
  }

  /// Drivers that write their own modules leave out what nobody checks; here it is checked.
  static void allow_demotion(Words& out) { append(out, kCapability, {kDemoteCapability}); }
  void declare_first_instance(Words& out) {
    if (facts_.first_instance_type == 0) return;
    first_instance_ = bound_++;
    append(out, kConstant, {facts_.first_instance_type, first_instance_, wish_.first_instance});
  }

  /// The constants and types that `add_main` uses; a type may stand only once.
  void declare(Words& out) {
    if (facts_.float_type == 0 || facts_.vector_type == 0 || facts_.function_type == 0)
      throw user_error("a shader module writes a position without the types of one");
    half_ = bound_++;
    append(out, kConstant, {facts_.float_type, half_, kHalf});
    if (!facts_.member) return;
    if (facts_.pointer_type == 0) {
      facts_.pointer_type = bound_++;
      append(out, kTypePointer, {facts_.pointer_type, kOutput, facts_.vector_type});
    }
    if (facts_.int_type == 0) {
      facts_.int_type = bound_++;
      append(out, kTypeInt, {facts_.int_type, 32, 1});
    }
    member_ = bound_++;
    append(out, kConstant, {facts_.int_type, member_, *facts_.member});
  }
  void add_main(Words& out, std::uint32_t main) {
    const auto fresh = [this] { return bound_++; };
    append(out, kFunction, {facts_.void_type, main, 0, facts_.function_type});
    append(out, kLabel, {fresh()});
    append(out, kFunctionCall, {facts_.void_type, fresh(), facts_.entry});
    std::uint32_t place = facts_.position;
    if (facts_.member) {
      place = fresh();
      append(out, kAccessChain, {facts_.pointer_type, place, facts_.position, member_});
    }
    const std::uint32_t old = fresh(), z = fresh(), w = fresh(), sum = fresh(), half = fresh(),
                        moved = fresh();
    append(out, kLoad, {facts_.vector_type, old, place});
    append(out, kCompositeExtract, {facts_.float_type, z, old, 2});
    append(out, kCompositeExtract, {facts_.float_type, w, old, 3});
    append(out, kFAdd, {facts_.float_type, sum, z, w});
    append(out, kFMul, {facts_.float_type, half, sum, half_});
    append(out, kCompositeInsert, {facts_.vector_type, moved, half, old, 2});
    append(out, kStore, {place, moved});
    append(out, kReturn, {});
    append(out, kFunctionEnd, {});
  }

  std::span<const std::uint32_t> words_;
  const ShaderWish& wish_;
  std::vector<Instruction> instructions_;
  Facts facts_;
  std::set<std::uint32_t> arrays_;  ///< types, and pointers to outputs of them
  bool demotes_ = false, may_demote_ = false;
  std::uint32_t block_pointer_ = 0, bound_ = 0, half_ = 0, member_ = 0, first_instance_ = 0;
};

}  // namespace

std::vector<Instruction> split(std::span<const std::uint32_t> words) {
  if (words.size() < kSpirvHeader || words[kSpirvBound] >= kMaxBound)
    throw user_error("a shader module has no SPIR-V header");
  std::vector<Instruction> instructions;
  for (std::size_t at = kSpirvHeader; at < words.size();) {
    const std::size_t count = words[at] >> 16;
    if (count == 0 || count > words.size() - at)
      throw user_error("a shader module ends within an instruction");
    instructions.push_back(words.subspan(at, count));
    at += count;
  }
  return instructions;
}

bool reads_first_instance(std::span<const std::uint32_t> module) {
  return std::ranges::any_of(split(module), is_first_instance);
}

std::vector<std::uint32_t> shader_words(std::span<const std::uint32_t> module, const ShaderWish& wish) {
  return Module(module, wish).rewritten();
}

}  // namespace quadrille::capture
