// SPDX-License-Identifier: GPL-3.0-or-later
/// A rank's growing set of elements: its own, then the rings that other ranks send.
#pragma once

#include "algebra/meshHalo.hpp"
#include "algebra/nodeNumbering.hpp"

namespace flotsam
{

class ElementRings
{
public:
    /// Collective.
    ElementRings(const LocalSimplices& local, MPI_Comm comm);

    /// Collective. Afterwards every element with an owned node is held.
    void addFirstRing();
    /// Collective, after addFirstRing. Afterwards every element that shares a node with those is held as well.
    void addSecondRing();

    struct Node
    {
        std::int64_t key;
        int owner;
    };
    struct Element
    {
        int home, index; ///< rank that brought it and its number there
        bool operator<(const Element& other) const { return home != other.home ? home < other.home : index < other.index; }
        bool operator==(const Element& other) const { return home == other.home && index == other.index; }
    };

    int dim, rank = 0, size = 1;
    std::vector<Node> nodes;        ///< own first (in the order brought)
    std::vector<double> x;
    std::vector<Element> elements;  ///< own first
    std::vector<int> elementNodes, facePatch;

    bool hasOwnedNode(int element) const;

private:
    struct Batch; // elements packed for, or from, one other rank
    void pack(int element, Batch& batch) const;
    /// Adds what is not held yet, in the order of (home, index).
    void exchange(const std::vector<Batch>& outgoing);
    void addNodes(const std::vector<Batch>& batches, const std::vector<std::pair<int, int>>& records);

    MPI_Comm comm_;
    KeyTable table_;
};

} // namespace flotsam
