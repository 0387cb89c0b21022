// Parts of the program that are libraries of their own, loaded when they are first needed.
#pragma once

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

}  // namespace elbowroom::core
