#pragma once

#include <cstddef>

namespace sumogamma::testing {

/// How often this program has taken something from the heap.
std::size_t heap_allocations();

}  // namespace sumogamma::testing
