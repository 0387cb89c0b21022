// The module behind sessions/print/printer.h.
#include "sessions/print/pdf_writer.h"
#include "sessions/print/pixel_painter.h"
#include "sessions/print/printer.h"

const elbowroom::sessions::Printer& ElbowroomPrinter() {
  using namespace elbowroom::sessions;
  static constexpr Printer kPrinter = {&WritePdf, &PaintOnPixels};
  return kPrinter;
}
