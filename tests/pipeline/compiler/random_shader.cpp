#include "tests/pipeline/compiler/random_shader.h"

#include "tests/pipeline/compiler/shader_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace quadrille::pipeline {
namespace {

using traces::ShaderStage;

/// Where a statement stands: which exits are allowed, which counters can be read.
struct Place {
  int depth = 0;
  bool in_loop = false, in_switch = false, in_main = false, returns_value = false;
  std::vector<std::string> counters;
};

class ShaderGenerator {
 public:
  ShaderGenerator(std::uint32_t seed, ShaderStage stage) : random_(seed * 2654435761u + 17), stage_(stage) {}

  RandomShader shader() {
    RandomShader result;
    result.stage = stage_;
    for (std::uint32_t count = below(4); callees_.size() < count;) {
      const bool returns_value = below(2) == 0;
      result.functions.push_back(function(callees_.size(), returns_value));
      callees_.push_back(returns_value);
    }
    Place place;
    place.depth = 2 + static_cast<int>(one_in(8) ? 3 : below(3));
    place.in_main = true;
    result.functions.push_back({main_head(), "  " + write_color() + "\n", block(place, 2)});
    return result;
  }

 private:
  std::uint32_t below(std::uint32_t n) { return random_() % n; }
  bool one_in(std::uint32_t n) { return below(n) == 0; }
  std::string variable() { return fmt::format("x{}", below(4)); }

  static std::string write_color() { return "color = pack(x0, x1, x2, x3);"; }
  [[nodiscard]] std::string main_head() const {
    const std::string start = stage_ == ShaderStage::kFragment
                                  ? "int x0 = int(gl_FragCoord.x) & 15, x1 = int(gl_FragCoord.y) & 1"
                                  : "int x0 = gl_VertexIndex & 15, x1 = (gl_VertexIndex >> 4) & 1";
    return fmt::format(
        "void main() {{\n  {}, x2 = (x0 * 5 + x1 * 3) & 7, x3 = x0 ^ (x1 * 9), m[2] = int[2](3, x0);\n  "
        "color = pack(x3, x2, x1, x0);\n{}",
        start, stage_ == ShaderStage::kVertex ? "  gl_Position = vec4(0, 0, 0, 1);\n" : "");
  }

  RandomFunction function(std::size_t index, bool returns_value) {
    Place place;
    place.depth = 1 + static_cast<int>(below(3));
    place.returns_value = returns_value;
    const std::string type = returns_value ? "int" : "void", mode = returns_value ? "" : "inout ";
    std::string head = fmt::format(
        "{0} f{1}({2}int x0, {2}int x1) {{\n  int x2 = x0 & 5, x3 = x1 + 2, m[2] = int[2](x1, x0);\n", type,
        index, mode);
    return {std::move(head), returns_value ? "  return (x0 + x1 * 3 + x2 + x3) & 63;\n" : "",
            block(place, 0)};
  }

  RandomBlock block(Place place, std::uint32_t least) {
    RandomBlock result;
    --place.depth;
    const std::uint32_t count = least + below(place.depth > 0 ? 4 : 3);
    while (result.size() < count) result.push_back(statement(place));
    // what follows it is dead
    if (one_in(8)) result.insert(result.begin() + (one_in(4) ? below(count + 1) : count), leave(place));
    return result;
  }
  RandomBlock block(const Place& place) { return block(place, one_in(6) ? 0 : 1); }

  RandomStatement statement(const Place& place) {
    if (place.depth <= 0) return one_in(4) ? guarded_exit(place) : assignment(place);
    switch (below(12)) {
      case 0:
      case 1: return {{fmt::format("if ({}) {{", condition(place)), "}"}, {block(place)}};
      case 2:
        return {{fmt::format("if ({}) {{", condition(place)), "} else {", "}"}, {block(place), block(place)}};
      case 3:
      case 4: return for_loop(place);
      case 5: return while_loop(place);
      case 6: return do_loop(place);
      case 7: return switch_of(place);
      case 8:
      case 9: return guarded_exit(place);
      case 10: return callees_.empty() ? assignment(place) : call(place);
      default: return assignment(place);
    }
  }

  RandomStatement assignment(const Place& place) {
    const std::string d = variable(), s = variable(), t = variable();
    switch (below(8)) {
      case 5: return {{fmt::format("m[{} & 1] = {};", operand(place), t)}, {}};
      case 6: return {{fmt::format("{} = (m[{} & 1] + {}) & 127;", d, operand(place), t)}, {}};
      case 7:
        return {{place.in_main && one_in(2) ? write_color() : fmt::format("m[{}] = {};", below(2), s)}, {}};
      case 0: return {{fmt::format("{} = ({} ^ {}) & 63;", d, s, operand(place))}, {}};
      case 1: return {{fmt::format("{} = {} ? {} : {};", d, condition(place), s, operand(place))}, {}};
      case 2: return {{fmt::format("{0} = min({0}, 200) + {1};", d, 1 + below(3))}, {}};
      default: return {{fmt::format("{} = ({} * {} + {}) & 255;", d, s, 1 + below(7), operand(place))}, {}};
    }
  }

  std::string operand(const Place& place) {
    if (!place.counters.empty() && one_in(3))
      return place.counters[below(static_cast<std::uint32_t>(place.counters.size()))];
    return one_in(4) ? fmt::format("{}", below(20)) : variable();
  }

  std::string condition(const Place& place) {
    switch (below(10)) {
      case 0: return one_in(2) ? "true" : "false";
      case 1: return fmt::format("({} && {})", comparison(place), comparison(place));
      case 2: return fmt::format("({} || {})", comparison(place), comparison(place));
      case 3: return fmt::format("!({})", comparison(place));
      default: return comparison(place);
    }
  }

  std::string comparison(const Place& place) {
    if (one_in(12)) {
      const auto pure = std::ranges::find(callees_, true);
      if (pure != callees_.end())
        return fmt::format("f{}({}, {}) > {}", pure - callees_.begin(), variable(), operand(place),
                           below(40));
    }
    switch (below(4)) {
      case 0: return fmt::format("({} & {}) == {}", operand(place), 1 + 2 * below(2), below(3));
      case 1: return fmt::format("{} > {}", operand(place), operand(place));
      default: return fmt::format("{} {} {}", operand(place), one_in(2) ? "<" : ">=", below(16));
    }
  }

  std::string attribute() {
    switch (below(6)) {
      case 0: return "[[unroll]] ";
      case 1: return "[[dont_unroll]] ";
      default: return "";
    }
  }

  /// A bound: a literal, or a few bits of a variable.
  std::string bound() {
    return one_in(2) ? fmt::format("{}", below(one_in(4) ? 12 : 5)) : fmt::format("({} & 3)", variable());
  }

  /// A new counter, which the statements inside may read.
  std::string counter(Place& inner) {
    inner.in_loop = true;
    inner.in_switch = false;
    inner.counters.push_back(fmt::format("c{}", counters_++));
    return inner.counters.back();
  }

  RandomStatement for_loop(const Place& place) {
    Place inner = place;
    const std::string most = bound(), c = counter(inner);
    std::string head;
    switch (below(6)) {
      case 0: head = fmt::format("for (int {0} = {1}; {0} > 0; --{0})", c, most); break;
      case 1: head = fmt::format("for (int {0} = 1, e{0} = {1}; {0} <= e{0}; {0} += 2)", c, most); break;
      case 2:
        head = fmt::format("for (int {0} = 0, e{0} = {1}; {0} < e{0} && {2}; ++{0})", c, most,
                           comparison(place));
        break;
      default: head = fmt::format("for (int {0} = 0, e{0} = {1}; {0} < e{0}; ++{0})", c, most); break;
    }
    return {{fmt::format("{}{} {{", attribute(), head), "}"}, {block(inner)}};
  }

  RandomStatement while_loop(const Place& place) {
    Place inner = place;
    const std::string most = bound(), c = counter(inner);
    if (one_in(3)) {  // the way out is inside
      return {{fmt::format("int {0} = 0; {2}for (;;) {{ if (++{0} > {1} + 1) break;", c,
                           one_in(2) ? most : "3", attribute()),
               "}"},
              {block(inner)}};
    }
    return {
        {fmt::format("int {0} = 0, e{0} = {1}; {2}while ({0} < e{0}) {{ ++{0};", c, most, attribute()), "}"},
        {block(inner)}};
  }

  RandomStatement do_loop(const Place& place) {
    Place inner = place;
    const std::string most = bound(), c = counter(inner);
    const std::string begin = fmt::format("int {0} = 0, e{0} = {1}; {2}do {{ ++{0};", c, most, attribute());
    const std::string again = one_in(3)   ? "false"
                              : one_in(3) ? fmt::format("{0} < e{0} && {1}", c, comparison(place))
                                          : fmt::format("{0} < e{0}", c);
    return {{begin, fmt::format("}} while ({});", again)}, {block(inner)}};
  }

  RandomStatement switch_of(const Place& place) {
    Place inner = place;
    inner.in_switch = true;
    RandomStatement result;
    std::string open = fmt::format("switch ({} & {}) {{", one_in(8) ? "2" : variable(), one_in(2) ? 3 : 7);
    const std::uint32_t cases = 1 + below(4), otherwise = below(6);
    for (std::uint32_t k = 0; k < cases; ++k) {
      if (k == otherwise) open += " default:";
      open += fmt::format(" case {}:", k);
      if (one_in(5)) open += fmt::format(" case {}:", k + cases);
      open += " {";
      result.text.push_back(open);
      result.blocks.push_back(block(inner));
      open = one_in(3) ? "}" : "} break;";
    }
    result.text.push_back(open + "}");
    return result;
  }

  RandomStatement call(const Place& place) {
    const auto callee = below(static_cast<std::uint32_t>(callees_.size())), d = below(4);
    if (!callees_[callee]) return {{fmt::format("f{}(x{}, x{});", callee, d, (d + 1 + below(3)) % 4)}, {}};
    if (one_in(4))
      return {{fmt::format("x{} = {} ? f{}({}, {}) : {};", d, comparison(place), callee, variable(),
                           operand(place), variable())},
              {}};
    return {{fmt::format("x{} = f{}({}, {});", d, callee, variable(), operand(place))}, {}};
  }

  /// break, continue, return or discard, whatever is allowed here.
  RandomStatement leave(const Place& place) {
    std::vector<std::string> ways{place.in_main ? "{ " + write_color() + " return; }"
                                                : (place.returns_value ? fmt::format("return {};", variable())
                                                                       : std::string("return;"))};
    if (place.in_loop) ways.insert(ways.end(), {"continue;", "break;", "continue;", "break;"});
    if (place.in_switch) ways.insert(ways.end(), {"break;", "break;"});
    if (stage_ == ShaderStage::kFragment && one_in(3)) ways.emplace_back("discard;");
    return {{ways[below(static_cast<std::uint32_t>(ways.size()))]}, {}};
  }
  RandomStatement guarded_exit(const Place& place) {
    RandomBlock body;
    if (one_in(3)) body.push_back(assignment(place));
    body.push_back(leave(place));
    return {{fmt::format("if ({}) {{", condition(place)), "}"}, {std::move(body)}};
  }

  Random random_;
  ShaderStage stage_;
  std::vector<bool> callees_;  ///< of each function: returns a value
  int counters_ = 0;
};

void write(std::string& out, const RandomBlock& block, std::size_t indent) {
  const std::string margin(2 * indent, ' ');
  for (const RandomStatement& statement : block) {
    for (std::size_t k = 0; k < statement.text.size(); ++k) {
      out += margin + statement.text[k] + "\n";
      if (k < statement.blocks.size()) write(out, statement.blocks[k], indent + 1);
    }
  }
}

std::size_t count(const RandomBlock& block) {
  std::size_t sum = 0;
  for (const RandomStatement& statement : block) {
    ++sum;
    for (const RandomBlock& inner : statement.blocks) sum += count(inner);
  }
  return sum;
}

/// Tries smaller programs in place, each by changing one block of the program and changing it back where that
/// no longer fails.
class Shrinker {
 public:
  Shrinker(RandomShader& shader, const std::function<bool(const RandomShader&)>& fails)
      : shader_(shader), fails_(fails) {}

  bool pass() {
    bool smaller = false;
    for (std::size_t k = shader_.functions.size(); k-- > 0;) smaller |= blocks(shader_.functions[k].body);
    for (std::size_t k = shader_.functions.size() - 1; k-- > 0;) {
      std::vector<RandomFunction> without = shader_.functions;
      without.erase(without.begin() + static_cast<std::ptrdiff_t>(k));
      smaller |= keep_if_failing(shader_.functions, std::move(without));
    }
    return smaller;
  }

 private:
  template <class T>
  bool keep_if_failing(T& target, T candidate) {
    std::swap(target, candidate);
    if (fails_(shader_)) return true;
    std::swap(target, candidate);
    return false;
  }

  bool blocks(RandomBlock& block) {
    bool smaller = false;
    for (std::size_t size = block.size(); size > 0; size /= 2) {
      for (std::size_t first = 0; first + size <= block.size();) {
        RandomBlock without = block;
        const auto begin = without.begin() + static_cast<std::ptrdiff_t>(first);
        without.erase(begin, begin + static_cast<std::ptrdiff_t>(size));
        if (keep_if_failing(block, std::move(without))) smaller = true;
        else ++first;
      }
    }
    for (std::size_t k = 0; k < block.size(); ++k) {
      for (std::size_t inner = 0; inner < block[k].blocks.size(); ++inner) {
        RandomBlock lifted(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(k));
        lifted.insert(lifted.end(), block[k].blocks[inner].begin(), block[k].blocks[inner].end());
        lifted.insert(lifted.end(), block.begin() + static_cast<std::ptrdiff_t>(k) + 1, block.end());
        if (keep_if_failing(block, std::move(lifted))) return true;
      }
      for (RandomBlock& inner : block[k].blocks) smaller |= blocks(inner);
    }
    return smaller;
  }

  RandomShader& shader_;
  const std::function<bool(const RandomShader&)>& fails_;
};

}  // namespace

std::string RandomShader::source() const {
  std::string out = "#version 450\n#extension GL_EXT_control_flow_attributes : require\n";
  out += stage == ShaderStage::kFragment ? "layout(location = 0) out vec4 color;\n"
                                         : "layout(location = 0) flat out vec4 color;\n";
  out +=
      "vec4 pack(int a, int b, int c, int d) {\n  return vec4(ivec4(a * 31 + b * 7 + c * 3 + d, b * 5 + c + "
      "d, c * 11 + d, d) & 255) / "
      "255.0;\n}\n";
  for (const RandomFunction& function : functions) {
    out += function.head;
    write(out, function.body, 1);
    out += function.tail + "}\n";
  }
  return out;
}

std::size_t RandomShader::statements() const {
  std::size_t sum = 0;
  for (const RandomFunction& function : functions) sum += count(function.body);
  return sum;
}

Seeds seeds_or(Seeds usual) {
  Seeds given{};
  const char* const text = std::getenv("QUADRILLE_SHADER_SEEDS");
  return text != nullptr && std::sscanf(text, "%u %u", &given.first, &given.count) == 2 ? given : usual;
}

RandomShader random_shader(std::uint32_t seed, ShaderStage stage) {
  return ShaderGenerator(seed, stage).shader();
}

RandomShader shrink(RandomShader shader, const std::function<bool(const RandomShader&)>& fails) {
  Shrinker shrinker(shader, fails);
  while (shrinker.pass()) {}
  return shader;
}

}  // namespace quadrille::pipeline
