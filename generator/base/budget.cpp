#include "generator/base/budget.hpp"

namespace hamgen {
namespace {

struct Account {
  Amounts spent{};
  bool is_open = false;
};

Account& account() {
  thread_local Account mine;
  return mine;
}

constexpr Amounts most = {1e6, 5e7, 1e7};

const char* description(Resource resource) {
  switch (resource) {
    case Resource::terms:
      return "this is written out more than 1000000 times";
    case Resource::work:
      return "this takes more than 50 million steps of algebra";
    case Resource::nodes:
      return "this makes expressions of more than 10 million operands";
  }
  return "";
}

const char* way_out(Resource resource) {
  switch (resource) {
    case Resource::terms:
      return "the terms of nested ranges multiply: sum over fewer, or give the inner sum as a "
             "formula";
    case Resource::work:
    case Resource::nodes:
      return "second derivatives have a term for each pair of factors, and one for each pair of "
             "variables that meet in a function: take fewer of them, a sum of such formulas, or a "
             "smaller size";
  }
  return "";
}

}  // namespace

OverBudget::OverBudget(Resource resource)
    : std::runtime_error(description(resource)), resource_(resource) {}

Budget::Budget() : is_first_(!account().is_open) {
  if (is_first_) account() = {.spent = {}, .is_open = true};
}

Budget::~Budget() {
  if (is_first_) account().is_open = false;
}

const Amounts& Budget::limits() { return most; }

void spend(Resource resource, double amount) {
  Account& mine = account();
  if (!mine.is_open) return;
  const auto place = static_cast<std::size_t>(resource);
  mine.spent[place] += amount;
  if (mine.spent[place] > most[place]) throw OverBudget(resource);
}

const Amounts& spent() { return account().spent; }

ModelError over_budget(const OverBudget& error, const Span& span, const SourceText& source,
                       const std::string& besides) {
  return {{{.severity = Severity::error,
            .span = span,
            .message = error.what(),
            .help = way_out(error.resource()) + besides}},
          source};
}

}  // namespace hamgen
