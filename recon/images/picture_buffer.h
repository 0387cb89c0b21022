// Memory for pixels that isn't cleared before they are written.
#pragma once

#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace elbowroom::recon {

// An allocator that leaves items without a value as the memory has them. Clearing 640 x 480 depths and
// normals, which are written right afterwards, would cost up to a fifth of the time of a view.
template <typename Item>
struct LeavesUnset : std::allocator<Item> {
  template <typename Other>
  struct rebind {
    using other = LeavesUnset<Other>;
  };

  template <typename Other>
  void construct(Other* place) {
    ::new (static_cast<void*>(place)) Other;
  }
  template <typename Other, typename... Arguments>
  void construct(Other* place, Arguments&&... arguments) {
    std::construct_at(place, std::forward<Arguments>(arguments)...);
  }
};

// A vector whose constructor by size and whose resize() give items no value: row-major, one a pixel.
template <typename Pixel>
using PictureBuffer = std::vector<Pixel, LeavesUnset<Pixel>>;

}  // namespace elbowroom::recon
