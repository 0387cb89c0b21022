// A verdict in the user's language.
#pragma once

#include <QString>

#include "core/contact.h"

namespace elbowroom::console {

[[nodiscard]] QString VerdictWord(core::Verdict verdict);  // "contact", "near", "clear", "undecided"

}  // namespace elbowroom::console
