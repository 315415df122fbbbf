/// Reads a listing (docs/isa.md, "Listing"): one directive or instruction a line, a `;` starts a comment.
/// Operands may be plain numbers; they become literals in the constant file.
#include "models/base/error.h"
#include "models/shader/decode.h"
#include "models/shader/listing_numbers.h"
#include "models/shader/listing_words.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace quadrille::models {
namespace {

/// Splits at any of `separators`, dropping empty pieces.
std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> pieces;
  while (true) {
    const std::size_t begin = text.find_first_not_of(separators);
    if (begin == std::string_view::npos) return pieces;
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    pieces.push_back(text.substr(begin, end - begin));
    text.remove_prefix(end);
  }
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

class Assembler {
 public:
  explicit Assembler(std::string_view name) { program_.name = name; }

  Program assemble(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      read_line(trimmed(text.substr(0, std::min(text.substr(0, end).find(';'), end))));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    finish();
    return std::move(program_);
  }

 private:
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> text, Args&&... args) const {
    throw user_error("{}:{}: {}", program_.name, line_, fmt::format(text, std::forward<Args>(args)...));
  }

  void read_line(std::string_view line) {
    if (line.empty()) return;
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    const std::string_view word = line.substr(0, end), rest = trimmed(line.substr(end));
    if (word.front() == '.') read_directive(word.substr(1), split(rest, " \t"));
    else read_instruction(word, split(rest, ","));
  }

  // Directives.

  void read_directive(std::string_view name, const std::vector<std::string_view>& words) {
    if (name == "stage") program_.stage = read_stage(words);
    else if (name == "varying")
      program_.varyings.push_back(one_of<Interpolation>(words, kInterpolationNames, "interpolation"));
    else if (name == "regs") registers_ = static_cast<int>(count(words, kMaxRegisters));
    else if (name == "constants") program_.constants.words = count(words, kMaxConstantWords);
    else if (name == "flags") read_flags(words);
    else if (name == "texture") read_texture(words);
    else if (name == "texop") read_texture_operation(words);
    else if (name == "color") read_color(words);
    else if (name == "buffer")
      program_.buffers.push_back({field(words, 0, "set"), field(words, 1, "binding")});
    else if (name == "input")
      program_.vertex_inputs.push_back(
          {small_field(words, 0, "location"), small_field(words, 1, "component")});
    else if (name == "extras") read_extras(words);
    else if (name == "literal") read_literals(words);
    else if (name == "push") read_block(words, ConstantLayout::Source::kPushConstant);
    else if (name == "uniform") read_block(words, ConstantLayout::Source::kUniformBlock);
    else
      fail(
          "unknown directive '.{}'; legal: stage regs flags constants literal push uniform texture texop "
          "color buffer input varying extras",
          name);
  }

  [[nodiscard]] ShaderStage read_stage(const std::vector<std::string_view>& words) const {
    std::array<std::string_view, kStages> names;
    for (std::size_t s = 0; s < kStages; ++s) names[s] = stage_info(static_cast<ShaderStage>(s)).name;
    return one_of<ShaderStage>(words, names, "stage");
  }

  template <class Enum, std::size_t kCount>
  [[nodiscard]] Enum one_of(const std::vector<std::string_view>& words,
                            const std::array<std::string_view, kCount>& names, std::string_view what) const {
    const auto found = words.size() == 1 ? std::find(names.begin(), names.end(), words[0]) : names.end();
    if (found == names.end()) {
      std::string legal;
      for (const std::string_view name : names) legal.append(" ").append(name);
      fail("{} must be one of:{}", what, legal);
    }
    return static_cast<Enum>(found - names.begin());
  }

  [[nodiscard]] std::uint32_t count(const std::vector<std::string_view>& words, std::uint32_t most) const {
    const auto value = words.size() == 1 ? parse_integer<std::uint32_t>(words[0]) : std::nullopt;
    if (!value || *value > most) fail("expected one number from 0 to {}", most);
    return *value;
  }

  void read_flags(const std::vector<std::string_view>& words) {
    for (const std::string_view word : words) {
      const auto* flag = std::find_if(kProgramFlags.begin(), kProgramFlags.end(),
                                      [&](const NamedFlag& f) { return f.name == word; });
      if (flag == kProgramFlags.end())
        fail(
            "unknown flag '{}'; legal: discard depth sample-mask by-sample early-tests derivatives "
            "atomic-outputs",
            word);
      program_.*flag->member = true;
    }
  }

  /// Of the numbers of a texture or colour: word `i`, or floats if there is none.
  [[nodiscard]] NumberKind kind(const std::vector<std::string_view>& words, std::size_t i) const {
    if (words.size() <= i) return NumberKind::kFloat;
    return one_of<NumberKind>({words[i]}, kNumberKindNames, "numbers");
  }

  /// Numbers, kind of view and sampler follow in this order, each where it is not the usual one.
  void read_texture(const std::vector<std::string_view>& words) {
    TextureBinding t{field(words, 0, "set"), field(words, 1, "binding")};
    std::size_t next = 2;
    const auto is_one_of = [&](const auto& names) {
      return next < words.size() && std::find(names.begin(), names.end(), words[next]) != names.end();
    };
    if (is_one_of(kNumberKindNames))
      t.texels = one_of<NumberKind>({words[next++]}, kNumberKindNames, "numbers");
    if (is_one_of(kViewKindNames)) t.view = one_of<ViewKind>({words[next++]}, kViewKindNames, "view");
    if (next < words.size() && words[next] == "no-sampler") {
      t.sampler_binding = kNoSampler;
      ++next;
    } else if (next < words.size() && words[next].starts_with("sampler-set")) {
      t.sampler_set = field(words, next, "sampler-set");
      t.sampler_binding = field(words, next + 1, "sampler-binding");
      next += 2;
    }
    if (next != words.size())
      fail("'{}' is none of: {}; {}; no-sampler; sampler-set=NUMBER sampler-binding=NUMBER", words[next],
           fmt::join(kNumberKindNames, " "), fmt::join(kViewKindNames, " "));
    program_.textures.push_back(t);
  }

  void read_texture_operation(const std::vector<std::string_view>& words) {
    if (words.size() != 9)
      fail(
          "a texture operation has 9 words: texture, what it asks, level, compare, offsets, component, x, y, "
          "z");
    TextureOperation o;
    o.texture = small_field(words, 0, "texture");
    o.ask = one_of<TextureAsk>({words[1]}, kTextureAskNames, "what a texture is asked");
    o.level = one_of<LevelFrom>({words[2]}, kLevelFromNames, "level");
    o.compare = field(words, 3, "compare") != 0;
    o.offsets = field(words, 4, "offsets") != 0;
    o.component = static_cast<std::uint8_t>(field(words, 5, "component") & 3u);
    constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis)
      o.offset.at(axis) = offset_field(words[6 + axis], kAxes.at(axis));
    program_.texture_operations.push_back(o);
  }
  [[nodiscard]] std::int8_t offset_field(std::string_view word, std::string_view axis) const {
    const bool named = word.starts_with(axis) && word.substr(axis.size()).starts_with('=');
    const auto value = named ? parse_integer<std::int8_t>(word.substr(axis.size() + 1)) : std::nullopt;
    if (!value) fail("expected '{}=OFFSET' instead of '{}'", axis, word);
    return *value;
  }

  void read_color(const std::vector<std::string_view>& words) {
    const std::uint32_t location = field(words, 0, "location");
    if (location >= program_.color_kinds.size())
      fail("location is {}; legal: at most {}", location, program_.color_kinds.size() - 1);
    program_.color_kinds[location] = kind(words, 1);
  }

  void read_extras(const std::vector<std::string_view>& words) {
    const auto at_most = [&](std::size_t i, std::string_view name, std::uint32_t most) {
      const std::uint32_t value = field(words, i, name);
      if (value > most) fail("{} is {}; legal: at most {}", name, value, most);
      return static_cast<std::uint8_t>(value);
    };
    program_.extras.point_size = at_most(0, "point_size", 1) != 0;
    program_.extras.clip_distances = at_most(1, "clip", kMaxUserDistances);
    program_.extras.cull_distances = at_most(2, "cull", kMaxUserDistances);
    program_.extras.viewport_index = at_most(3, "viewport", 1) != 0;
  }

  /// The value of word `i`, which must read `name=number`.
  [[nodiscard]] std::uint32_t field(const std::vector<std::string_view>& words, std::size_t i,
                                    std::string_view name) const {
    const std::string_view word = i < words.size() ? words[i] : std::string_view{};
    const bool named = word.starts_with(name) && word.substr(name.size()).starts_with('=');
    const auto value = named ? parse_integer<std::uint32_t>(word.substr(name.size() + 1)) : std::nullopt;
    if (!value) fail("expected '{}=NUMBER' instead of '{}'", name, word);
    return *value;
  }
  [[nodiscard]] std::uint16_t small_field(const std::vector<std::string_view>& words, std::size_t i,
                                          std::string_view name) const {
    const std::uint32_t value = field(words, i, name);
    if (value > std::numeric_limits<std::uint16_t>::max()) fail("{} is {}; legal: 0 to 65535", name, value);
    return static_cast<std::uint16_t>(value);
  }

  [[nodiscard]] std::uint32_t first_word(const std::vector<std::string_view>& words) const {
    const auto first = words.empty() ? std::nullopt : slot(words[0], "c");
    if (!first) fail("expected the first constant word, such as 'c0'");
    return *first;
  }

  void read_literals(const std::vector<std::string_view>& words) {
    ConstantLayout::Range range;
    range.first_word = first_word(words);
    for (std::size_t i = 1; i < words.size(); ++i) {
      const auto bits = parse_literal(words[i]);
      if (!bits) fail("'{}' is not a number", words[i]);
      range.literals.push_back(*bits);
    }
    range.words = static_cast<std::uint32_t>(range.literals.size());
    add_range(std::move(range));
  }

  void read_block(const std::vector<std::string_view>& words, ConstantLayout::Source source) {
    ConstantLayout::Range range;
    range.source = source;
    range.first_word = first_word(words);
    std::size_t next = 1;
    if (source == ConstantLayout::Source::kUniformBlock) {
      range.set = field(words, next++, "set");
      range.binding = field(words, next++, "binding");
    }
    range.byte_offset = field(words, next++, "offset");
    range.words = field(words, next, "words");
    if (range.words > kMaxConstantWords)
      fail("a block of {} words; legal: 0 to {}", range.words, kMaxConstantWords);
    add_range(std::move(range));
  }

  void add_range(ConstantLayout::Range range) {
    const std::uint32_t end = range.first_word + range.words;  // each below 2^17
    if (end > kMaxConstantWords) fail("the range ends at word {}; legal: at most {}", end, kMaxConstantWords);
    program_.constants.words = std::max(program_.constants.words, end);
    program_.constants.ranges.push_back(std::move(range));
  }

  // Instructions.

  void read_instruction(std::string_view word, const std::vector<std::string_view>& fields) {
    Instruction in;
    if (word.ends_with(".sat")) {
      in.flags = Instruction::kSaturate;
      word.remove_suffix(4);
    }
    const OpInfo* info = find_op(word);
    if (info == nullptr) fail("unknown operation '{}'", word);
    in.op = info->op;
    const std::size_t expected = (info->destinations != 0 ? 1u : 0u) +
                                 (info->immediate != Immediate::kUnused ? 1u : 0u) + info->sources;
    if (fields.size() != expected) fail("'{}' takes {} operands, {} given", word, expected, fields.size());
    auto next = fields.begin();
    if (info->destinations != 0) in.dst = read_destination(trimmed(*next++));
    if (info->destinations != 0)
      highest_register_ = std::max(highest_register_, in.dst + info->destinations - 1);
    if (info->immediate != Immediate::kUnused) in.imm = read_immediate(trimmed(*next++), info->immediate);
    Operand* const operands[] = {&in.a, &in.b, &in.c};
    for (int i = 0; i < info->sources; ++i)
      *operands[i] = read_operand(trimmed(*next++), i, operand_width(in.op));
    program_.code.push_back(in);
    lines_.push_back(line_);
  }

  /// The number after `prefix`.
  [[nodiscard]] static std::optional<std::uint16_t> slot(std::string_view text, std::string_view prefix) {
    if (!text.starts_with(prefix)) return std::nullopt;
    return parse_integer<std::uint16_t>(text.substr(prefix.size()));
  }

  [[nodiscard]] std::uint16_t read_destination(std::string_view text) const {
    const auto index = slot(text, "r");
    if (!index) fail("the destination must be a register, not '{}'", text);
    return *index;
  }

  [[nodiscard]] std::uint16_t read_immediate(std::string_view text, Immediate immediate) const {
    const auto* system = std::find(kSystemValueNames.begin(), kSystemValueNames.end(), text);
    if (immediate == Immediate::kInputSlot && system != kSystemValueNames.end())
      return static_cast<std::uint16_t>(kFirstSystemValue + (system - kSystemValueNames.begin()));
    const auto index = slot(text, slot_prefix(immediate));
    if (!index) fail("expected '{}NUMBER' instead of '{}'", slot_prefix(immediate), text);
    return *index;
  }

  /// `width`: registers that one stands for.
  Operand read_operand(std::string_view text, int position, int width) {
    if (const auto bits = parse_literal(text)) {
      numbers_.push_back({program_.code.size(), position});
      return {Operand::kConstant, 0, place_of(*bits)};
    }
    Operand operand;
    std::string_view rest = text;
    if (rest.starts_with('-')) {
      operand.modifiers |= Operand::kNegate;
      rest.remove_prefix(1);
    }
    if (rest.size() > 2 && rest.front() == '|' && rest.back() == '|') {
      operand.modifiers |= Operand::kAbsolute;
      rest = rest.substr(1, rest.size() - 2);
    }
    operand.kind = rest.starts_with('c') ? Operand::kConstant : Operand::kRegister;
    const auto index = slot(rest, operand.kind == Operand::kConstant ? "c" : "r");
    if (!index) fail("'{}' is no operand; legal: rN, cN, a number, with - and | | on rN and cN", text);
    operand.index = *index;
    if (operand.kind == Operand::kRegister)
      highest_register_ = std::max(highest_register_, operand.index + width - 1);
    return operand;
  }

  /// Index of a number among those that operands give; they are put behind the declared constants at the end.
  std::uint16_t place_of(std::uint32_t bits) {
    const auto found = std::find(literals_.begin(), literals_.end(), bits);
    const auto index = static_cast<std::uint16_t>(found - literals_.begin());
    if (found == literals_.end()) literals_.push_back(bits);
    if (literals_.size() >= kMaxConstantWords) fail("more than {} different numbers", kMaxConstantWords);
    return index;
  }

  void place_literals() {
    if (literals_.empty()) return;
    const std::uint32_t first = program_.constants.words;
    if (first + literals_.size() > kMaxConstantWords)
      fail("constants and numbers need {} words; legal: at most {}", first + literals_.size(),
           kMaxConstantWords);
    for (const NumberUse& use : numbers_) {
      Instruction& in = program_.code[use.instruction];
      Operand& operand = use.position == 0 ? in.a : use.position == 1 ? in.b : in.c;
      operand.index = static_cast<std::uint16_t>(operand.index + first);
    }
    ConstantLayout::Range range;
    range.first_word = first;
    range.words = static_cast<std::uint32_t>(literals_.size());
    range.literals = literals_;
    add_range(std::move(range));
  }

  void finish() {
    place_literals();
    program_.num_regs = registers_.value_or(highest_register_ + 1);
    const std::optional<ProgramFault> fault = program_fault(program_);
    if (!fault) return;
    if (fault->instruction < lines_.size()) line_ = lines_[fault->instruction];
    fail("{}", fault->what);
  }

  static constexpr std::uint32_t kMaxConstantWords = 65536;
  struct NumberUse {
    std::size_t instruction = 0;
    int position = 0;  ///< of the operand
  };

  Program program_;
  int line_ = 0;
  std::vector<int> lines_;  ///< of each instruction
  std::vector<std::uint32_t> literals_;
  std::vector<NumberUse> numbers_;
  std::optional<int> registers_;
  int highest_register_ = -1;
};

}  // namespace

Program assemble(std::string_view text, std::string_view name) { return Assembler(name).assemble(text); }

}  // namespace quadrille::models
