// The other side of ImportInChild: the child's work.
#pragma once

namespace elbowroom::cad_import {

// To be called first in the main of every program that imports. If this process was started to read a file,
// this reads the file and ends the process. Otherwise it returns, and the program may import.
void ServeImport(int argc, char** argv);

// Whether this program's main called ServeImport.
[[nodiscard]] bool ServesImports();

}  // namespace elbowroom::cad_import
