#include "sessions/print/printer.h"

#include "core/system/module.h"

namespace elbowroom::sessions {

const Printer& LoadedPrinter() {
  static const Printer& printer =
      core::FunctionOfModule<decltype(ElbowroomPrinter)>("printer", "ElbowroomPrinter")();
  return printer;
}

}  // namespace elbowroom::sessions
