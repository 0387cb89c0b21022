// The other side of ImportInChild: the child's work.
#pragma once

namespace elbowroom::cad_import {

// To be called first in the main of every program that imports. If this process was started to read a file it
// does that and ends; else this returns, and the program may import.
void ServeImport(int argc, char** argv);

// Whether this program's main called that.
[[nodiscard]] bool ServesImports();

}  // namespace elbowroom::cad_import
