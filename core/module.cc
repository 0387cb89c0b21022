#include "core/module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/error.h"

namespace elbowroom::core {

void* FindInModule(const std::string& name, const char* entry) {
  const std::string file = fmt::format("libelbowroom_{}-{}.so", name, ELBOWROOM_VERSION);
  void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* address = module == nullptr ? nullptr : ::dlsym(module, entry);
  if (address != nullptr) return address;
  const char* why = ::dlerror();
  throw Error(ErrorKind::kFile,
              fmt::format("a part of the program can't be loaded ({}); it belongs beside the program: build "
                          "or install them together",
                          why == nullptr ? file : why));
}

}  // namespace elbowroom::core
