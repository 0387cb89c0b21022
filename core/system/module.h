// Parts of the program that are libraries of their own, loaded when they are first needed.
#pragma once

#include <filesystem>
#include <string>

namespace elbowroom::core {

// The address of `entry` in the module `name`, which is loaded then and stays. It is looked for where the
// program says that its own libraries are: beside it; its file's name carries the program's version. Throws:
// Error{kFile} saying what is missing. Thread: any.
[[nodiscard]] void* FindInModule(const std::string& name, const char* entry);

// As the function that it is: a module's header declares it.
template <typename Function>
[[nodiscard]] Function* FunctionOfModule(const std::string& name, const char* entry) {
  return reinterpret_cast<Function*>(FindInModule(name, entry));
}

// The program `elbowroom_NAME-VERSION` that lies among the modules. Throws: Error{kFile} naming it if it
// isn't there. Thread: any.
[[nodiscard]] std::filesystem::path FindProgramBeside(const std::string& name);

}  // namespace elbowroom::core
