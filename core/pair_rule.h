// Whether two parts keep their pair rule.
#pragma once

#include "core/contact.h"

namespace elbowroom::core {

// Whether two parts of this verdict break their rule. Where that isn't certain they do.
[[nodiscard]] constexpr bool BreaksPairRule(Verdict verdict, bool authorised_contact) {
  return verdict != Verdict::kClear && !(verdict == Verdict::kContact && authorised_contact);
}

}  // namespace elbowroom::core
