// The kinds of question that are asked about hard shapes, and what each case of them took.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace elbowroom::accuracy {

struct HardCost {
  std::string hull, part, place;
  double ms = 0.0;
  double work = 0.0;  // how many of HardKind::counted
};

// One kind of question: what it took for each case, one thread, hull in memory, and what was wrong with the
// answers.
struct HardKind {
  std::string name;
  std::string counted;  // what the work is made of
  std::string unit;     // of worst_error; empty: only right or wrong is told
  std::vector<HardCost> costs = {};
  std::int64_t wrong = 0;    // answers that break what is promised
  std::int64_t checked = 0;  // answers that were held to an oracle
  double worst_error = 0.0;

  // Counts one answer that was held to an oracle.
  void Check(bool is_right, double error);
};

// All kinds of question, apart where the questions differ: about a part that touches, that is amid the hull,
// that is away from it.
struct HardKinds {
  HardKind contacts_away{"contacts, away", "queries", ""};
  HardKind contacts_touching{"contacts, touching", "queries", ""};
  HardKind contacts_amid{"contacts, amid", "queries", ""};
  HardKind beside{"clearance, beside", "queries", "mm"};
  HardKind around{"clearance, around", "queries", "mm"};
  HardKind straight{"recovery, straight", "edges", "mm"};
  HardKind hinge{"recovery, about a hinge", "edges", "mm"};
  HardKind heat_touching{"heat map, touching", "touched patches", ""};
  HardKind heat_amid{"heat map, amid", "touched patches", ""};
  HardKind view_of_four{"exact view, 4 cameras, 640 x 480", "pixels of hull", "of the depth"};
  HardKind view_of_eight{"exact view, 8 cameras, 1280 x 720", "pixels of hull", "of the depth"};
  HardKind frame{"assembly, frame of 300 parts", "parts asked", ""};
  HardKind skipped{"assembly, a part settled by a ball", "queries", ""};
  HardKind asked{"assembly, any other part", "queries", "mm"};

  [[nodiscard]] std::vector<HardKind> InOrder() const;
};

}  // namespace elbowroom::accuracy
