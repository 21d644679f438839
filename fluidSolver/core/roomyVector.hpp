// SPDX-License-Identifier: GPL-3.0-or-later
/// Vectors that are filled anew in every step, with about as much as in the step before.
#pragma once

#include <vector>

namespace flotsam
{

/// Room for n entries, an eighth more when it has to grow: what grows slowly asks for memory rarely. What it held is void.
template<class T, class Size>
void reserveRoom(std::vector<T>& v, Size n)
{
    const std::size_t wanted = std::size_t(n);
    if (v.capacity() >= wanted) return;
    std::vector<T>().swap(v); // first, or both are there at once
    v.reserve(wanted + wanted/8);
}

} // namespace flotsam
