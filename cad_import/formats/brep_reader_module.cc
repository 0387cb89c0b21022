// The module of the reader of boundary representations.
#include "cad_import/formats/format_modules.h"

elbowroom::cad_import::BrepReader& ElbowroomBrepReader() { return elbowroom::cad_import::ReadBrep; }
