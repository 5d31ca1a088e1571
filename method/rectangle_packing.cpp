#include "method/rectangle_packing.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#define STBRP_STATIC
#include <stb/stb_rect_pack.h>

namespace {

/// In place of qsort, which leaves the order of equals to the C library.
void sort_stably(stbrp_rect* items, std::size_t count, std::size_t,
                 int (*compare)(const void*, const void*)) {
  std::stable_sort(items, items + count,
                   [&](const stbrp_rect& a, const stbrp_rect& b) { return compare(&a, &b) < 0; });
}

}  // namespace

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STBRP_SORT sort_stably
#define STB_RECT_PACK_IMPLEMENTATION
#include <stb/stb_rect_pack.h>
#pragma GCC diagnostic pop

namespace fluxel {

bool pack(std::span<PackedRectangle> rectangles, int width, int height) {
  std::vector<stbrp_node> nodes(static_cast<std::size_t>(width));
  stbrp_context context;
  stbrp_init_target(&context, width, height, nodes.data(), width);
  std::vector<stbrp_rect> items;
  items.reserve(rectangles.size());
  for (const PackedRectangle& rectangle : rectangles) {
    stbrp_rect& item = items.emplace_back();
    item.w = rectangle.width;
    item.h = rectangle.height;
  }
  if (stbrp_pack_rects(&context, items.data(), static_cast<int>(items.size())) == 0) return false;
  for (std::size_t k = 0; k < items.size(); ++k) {
    rectangles[k].x = items[k].x;
    rectangles[k].y = items[k].y;
  }
  return true;
}

}  // namespace fluxel
