// Pixels that whoever makes a picture writes first.
#pragma once

#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace elbowroom::recon {

// Leaves items without a value as memory has them: of 640 x 480 depths and normals clearing what is written
// again at once costs as much as a fifth of the view.
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
