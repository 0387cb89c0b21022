// Modules: parts of the program that are shared libraries of their own and are loaded on first use.
#pragma once

#include <filesystem>
#include <string>

namespace elbowroom::core {

// The address of `entry` in the module `name`. The first call loads the module, which is never unloaded. The
// loader looks for it where it looks for the program's own libraries, beside the program; its file's name
// carries the program's version. Throws: Error{kFile} saying what is missing. Thread: any.
[[nodiscard]] void* FindInModule(const std::string& name, const char* entry);

// The same address as a function pointer. The module's header declares the function's type.
template <typename Function>
[[nodiscard]] Function* FunctionOfModule(const std::string& name, const char* entry) {
  return reinterpret_cast<Function*>(FindInModule(name, entry));
}

// The program `elbowroom_NAME-VERSION` that lies among the modules. Throws: Error{kFile} naming it if it
// isn't there. Thread: any.
[[nodiscard]] std::filesystem::path FindProgramBeside(const std::string& name);

}  // namespace elbowroom::core
