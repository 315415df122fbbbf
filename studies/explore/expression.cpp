#include "studies/explore/expression.h"

#include <muParser.h>

#include <cmath>

#include "models/base/error.h"

namespace quadrille::studies::explore {
namespace {

double floor_of(double x) { return std::floor(x); }
double ceil_of(double x) { return std::ceil(x); }
double remainder_of(double x, double y) { return std::fmod(x, y); }

std::string reason(const mu::Parser::exception_type& error) {
  std::string text = error.GetMsg();
  while (text.ends_with('\n') || text.ends_with('.')) text.pop_back();
  return text;
}

}  // namespace

struct Expression::Parser {
  mu::Parser parser;
  std::vector<double> values;  ///< of the names; the parser points into it
};

Expression::Expression(const std::string& text, std::string where)
    : text_(text), where_(std::move(where)), parser_(std::make_unique<Parser>()) {
  mu::Parser& parser = parser_->parser;
  parser.DefineNameChars("0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
  parser.DefineFun("floor", floor_of);
  parser.DefineFun("ceil", ceil_of);
  parser.DefineFun("mod", remainder_of);
  try {
    parser.SetExpr(text);
    for (const auto& [name, unused] : parser.GetUsedVar()) names_.push_back(name);
    parser_->values.assign(names_.size(), 1);
    for (std::size_t i = 0; i < names_.size(); ++i) parser.DefineVar(names_[i], &parser_->values[i]);
    (void)parser.Eval();
    if (parser.GetNumResults() != 1) throw user_error("{}: '{}': one value is expected", where_, text);
  } catch (const mu::Parser::exception_type& error) {
    throw user_error("{}: '{}': {}", where_, text, reason(error));
  }
}

Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;

double Expression::value(const std::function<double(const std::string&)>& lookup) const {
  for (std::size_t i = 0; i < names_.size(); ++i) parser_->values[i] = lookup(names_[i]);
  try {
    const double result = parser_->parser.Eval();
    if (std::isfinite(result)) return result;
  } catch (const mu::Parser::exception_type& error) {
    throw user_error("{}: '{}': {}", where_, text_, reason(error));
  }
  throw user_error("{}: '{}': the result is no finite number", where_, text_);
}

}  // namespace quadrille::studies::explore
