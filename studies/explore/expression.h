/// Formulas of a sweep file, over parameters and figures: `2 * gpu.cores`, `frame.cycles / gpu.clock_mhz`.
///
/// muParser reads them: its operators and functions, with `floor`, `ceil` and `mod` beside. A name is
/// letters, digits, dots and underscores. True is 1 and false is 0.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace quadrille::studies::explore {

class Expression {
 public:
  /// `where` leads errors: "sweep.toml:12: constraints". Throws `UserError` for what is no formula.
  Expression(const std::string& text, std::string where);
  ~Expression();
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::string& where() const { return where_; }
  /// The names that it refers to, in alphabetical order.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// `lookup` gives the value of a name. Throws what it throws, and `UserError` when the result is no finite
  /// number.
  [[nodiscard]] double value(const std::function<double(const std::string&)>& lookup) const;

 private:
  struct Parser;
  std::string text_, where_;
  std::vector<std::string> names_;
  std::unique_ptr<Parser> parser_;
};

}  // namespace quadrille::studies::explore
