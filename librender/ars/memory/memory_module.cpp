#include "librender/ars/memory/memory_module.h"

namespace deltaz::ars {

std::string_view tieRuleName(TieRule rule) {
  return rule == TieRule::kFirstStays ? "first" : "brighter";
}

std::optional<TieRule> tieRuleNamed(std::string_view name) {
  for (const TieRule rule : {TieRule::kFirstStays, TieRule::kBrighter})
    if (tieRuleName(rule) == name) return rule;
  return std::nullopt;
}

std::int64_t MemoryCounts::writes() const {
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < kWriteCycleCount; ++k) sum += cycles[k];
  return sum;
}

MemoryCounts& MemoryCounts::operator+=(const MemoryCounts& other) {
  for (std::size_t k = 0; k < kMemoryCycleCount; ++k) cycles[k] += other.cycles[k];
  ties += other.ties;
  split_ties += other.split_ties;
  return *this;
}

}  // namespace deltaz::ars
