#include "core/system/module.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>
#include <unistd.h>

#include <cstddef>
#include <span>
#include <vector>

#include "core/error.h"

namespace elbowroom::core {

namespace {

[[noreturn]] void FailAsMissing(const std::string& why) {
  throw Error(ErrorKind::kFile,
              fmt::format("a part of the program can't be loaded ({}); it belongs beside the program: build "
                          "or install them together",
                          why));
}

// The folders in which the loader looks for this program's own libraries.
std::vector<std::filesystem::path> ModuleFolders() {
  void* program = ::dlopen(nullptr, RTLD_NOW);
  Dl_serinfo size{};
  Require(program != nullptr && ::dlinfo(program, RTLD_DI_SERINFOSIZE, &size) == 0,
          "the loader knows its folders");
  std::vector<std::max_align_t> memory(size.dls_size / sizeof(std::max_align_t) + 1);
  auto* info = reinterpret_cast<Dl_serinfo*>(memory.data());
  std::vector<std::filesystem::path> folders;
  if (::dlinfo(program, RTLD_DI_SERINFOSIZE, info) == 0 && ::dlinfo(program, RTLD_DI_SERINFO, info) == 0) {
    for (const Dl_serpath& folder : std::span(info->dls_serpath, info->dls_cnt))
      folders.emplace_back(folder.dls_name);
  }
  ::dlclose(program);
  return folders;
}

}  // namespace

void* FindInModule(const std::string& name, const char* entry) {
  const std::string file = fmt::format("libelbowroom_{}-{}.so", name, ELBOWROOM_VERSION);
  void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* address = module == nullptr ? nullptr : ::dlsym(module, entry);
  if (address != nullptr) return address;
  const char* why = ::dlerror();
  FailAsMissing(why == nullptr ? file : why);
}

std::filesystem::path FindProgramBeside(const std::string& name) {
  const std::string file = fmt::format("elbowroom_{}-{}", name, ELBOWROOM_VERSION);
  for (const std::filesystem::path& folder : ModuleFolders()) {
    std::filesystem::path program = folder / file;
    if (::access(program.c_str(), X_OK) == 0) return program;
  }
  FailAsMissing(file + ": no such program");
}

}  // namespace elbowroom::core
