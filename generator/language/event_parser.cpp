#include "generator/language/event_parser.hpp"

#include <fmt/format.h>

#include "generator/language/parser.hpp"

namespace hamgen {
namespace {

bool is_comparison_sign(const Token& token) {
  for (const char* sign : {"<", ">", "<=", ">=", "==", "!="}) {
    if (is_symbol(token, sign)) return true;
  }
  return false;
}

}  // namespace

ModelEvent crossing(ExpressionParser& in, const SourceText& source) {
  const std::size_t begin = in.peek().span.begin;
  ModelEvent event;
  event.value = in.expression();
  event.formula = one_line(source, {begin, in.previous().span.end});
  if (in.at_direction()) {
    event.rising = in.peek().text == "rising";
    event.falling = !event.rising;
    in.next();
  }
  event.text = one_line(source, {begin, in.previous().span.end});
  return event;
}

EndSyntax end_of_run(ExpressionParser& in, const SourceText& source) {
  EndSyntax result;
  result.crossing = crossing(in, source);
  const Token& sign = in.peek();
  if (!is_comparison_sign(sign)) return result;
  if (!is_symbol(sign, "<") && !is_symbol(sign, ">")) {
    in.fail(sign.span, fmt::format("'{}' is not known here", sign.text),
            "write A > B or A < B; where A equals B is a crossing: A - B");
  }
  result.less = sign.text == "<";
  in.next();
  result.right = in.expression();
  if (in.at_direction()) in.fail(in.peek().span, "a comparison has no direction", "leave it out");
  return result;
}

}  // namespace hamgen
