#include "tests/accuracy/hard/hard_kinds.h"

#include <algorithm>

namespace elbowroom::accuracy {

void HardKind::Check(bool is_right, double error) {
  ++checked;
  wrong += is_right ? 0 : 1;
  worst_error = std::max(worst_error, error);
}

std::vector<HardKind> HardKinds::InOrder() const {
  return {contacts_away, contacts_touching, contacts_amid, beside,        around, straight, hinge,
          heat_touching, heat_amid,         view_of_four,  view_of_eight, frame,  skipped,  asked};
}

}  // namespace elbowroom::accuracy
