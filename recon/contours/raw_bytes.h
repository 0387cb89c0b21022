// Numbers as the bytes that this machine has for them: for what a program keeps for itself.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {

class RawWriter {
 public:
  template <typename Item>
  void Add(std::span<const Item> items) {
    static_assert(std::is_trivially_copyable_v<Item>);
    bytes_.append(reinterpret_cast<const char*>(items.data()), items.size_bytes());
  }
  template <typename Item>
  void AddOne(const Item& item) {
    Add(std::span(&item, 1));
  }

  [[nodiscard]] std::string Take() && { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Each member throws core::Error{kFile} where the bytes aren't what a RawWriter wrote.
class RawReader {
 public:
  explicit RawReader(std::string_view bytes) : left_(bytes) {}

  template <typename Item>
  void Read(std::span<Item> items) {
    static_assert(std::is_trivially_copyable_v<Item>);
    Check(items.size_bytes() <= left_.size());
    if (!items.empty()) std::memcpy(items.data(), left_.data(), items.size_bytes());
    left_.remove_prefix(items.size_bytes());
  }
  template <typename Item>
  [[nodiscard]] Item ReadOne() {
    Item item;
    Read(std::span(&item, 1));
    return item;
  }
  // A number of items that follow, of at least so many bytes each.
  [[nodiscard]] std::size_t ReadCount(std::size_t item_bytes) {
    const auto count = ReadOne<std::size_t>();
    Check(count <= left_.size() / item_bytes);
    return count;
  }

  static void Check(bool is_so) {
    if (!is_so) throw core::Error(core::ErrorKind::kFile, "the bytes of a contour are damaged");
  }

 private:
  std::string_view left_;
};

}  // namespace elbowroom::recon
