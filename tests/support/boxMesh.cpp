// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/boxMesh.hpp"

#include "core/simplexFaces.hpp"

#include <algorithm>
#include <stdexcept>

namespace flotsam
{
namespace
{

using Index = std::array<int, 3>;

/// The grid of all ranks and this rank's slab of node planes [begin, end).
class BoxBuilder
{
public:
    BoxBuilder(MPI_Comm comm, int dim, Index cells, std::array<double, 3> lower, std::array<double, 3> upper)
        : dim_(dim), cells_(cells), lower_(lower), upper_(upper)
    {
        MPI_Comm_rank(comm, &rank_);
        MPI_Comm_size(comm, &size_);
        if (dim_ == 2)
        {
            cells_[2] = 0;
        }
        if (dim < 2 || dim > 3 || cells_[0] + 1 < size_ || cells_[0] < 1 || cells_[1] < 1 || (dim == 3 && cells_[2] < 1))
        {
            throw std::invalid_argument("makeBoxMesh: dim 2 or 3, at least one cell a direction and cells[0]+1 >= ranks");
        }
        begin_ = firstPlane(rank_);
        end_ = firstPlane(rank_ + 1);
        heldBegin_ = std::max(begin_ - 2, 0);
        heldEnd_ = std::min(end_ + 2, cells_[0] + 1);
    }

    SimplexMesh build(double perturbation, bool alternateDiagonals, int seed)
    {
        perturbation_ = perturbation;
        seed_ = seed;
        alternate_ = alternateDiagonals;
        mesh_.dim = dim_;
        if (dim_ == 2 && upper_[2] > lower_[2])
        {
            mesh_.planeOffset = 0.5 * (lower_[2] + upper_[2]);
            mesh_.thickness = upper_[2] - lower_[2];
        }
        addNodes();
        addElements();
        mesh_.computeGeometry();
        addPatches();
        return std::move(mesh_);
    }

private:
    int firstPlane(int rank) const { return static_cast<int>(static_cast<long>(cells_[0] + 1) * rank / size_); }
    int nodesPerPlane() const { return (cells_[1] + 1) * (cells_[2] + 1); }

    int ownerOf(int plane) const
    {
        int rank = 0;
        while (firstPlane(rank + 1) <= plane)
        {
            ++rank;
        }
        return rank;
    }

    std::int64_t original(const Index& i) const
    {
        return i[0] + (cells_[0] + 1) * (i[1] + std::int64_t(cells_[1] + 1) * i[2]);
    }

    std::int64_t global(const Index& i) const
    {
        const int owner = ownerOf(i[0]), first = firstPlane(owner), planes = firstPlane(owner + 1) - first;
        return std::int64_t(first) * nodesPerPlane() + (i[0] - first) + std::int64_t(planes) * (i[1] + (cells_[1] + 1) * i[2]);
    }

    int& local(const Index& i)
    {
        return localNode_[(i[0] - heldBegin_) + (heldEnd_ - heldBegin_) * (i[1] + (cells_[1] + 1) * i[2])];
    }

    /// In [-1, 1], from the node number, the direction and the seed (splitmix64).
    double randomNumber(std::int64_t node, int direction) const
    {
        std::uint64_t z = ((static_cast<std::uint64_t>(node) * 3 + direction + 1) ^ (static_cast<std::uint64_t>(seed_) << 48)) * 0x9e3779b97f4a7c15ull;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        z ^= z >> 31;
        return 2 * (static_cast<double>(z >> 11) / 9007199254740992.0) - 1;
    }

    void addNode(const Index& i)
    {
        bool isInterior = true;
        for (int d = 0; d < dim_; ++d)
        {
            isInterior = isInterior && i[d] > 0 && i[d] < cells_[d];
        }
        for (int d = 0; d < dim_; ++d)
        {
            const double shift = isInterior ? perturbation_ * randomNumber(original(i), d) : 0;
            mesh_.x.push_back(lower_[d] + (upper_[d] - lower_[d]) * ((i[d] + shift) / cells_[d]));
        }
        local(i) = mesh_.nNodes++;
        mesh_.globalNode.push_back(global(i));
        mesh_.originalNode.push_back(original(i));
        mesh_.nodeOwner.push_back(ownerOf(i[0]));
    }

    void addPlanes(int begin, int end)
    {
        for (int k = 0; k <= cells_[2]; ++k)
        {
            for (int j = 0; j <= cells_[1]; ++j)
            {
                for (int i = begin; i < end; ++i)
                {
                    addNode({i, j, k});
                }
            }
        }
    }

    void addNodes()
    {
        localNode_.assign(static_cast<std::size_t>(heldEnd_ - heldBegin_) * nodesPerPlane(), -1);
        addPlanes(begin_, end_);
        mesh_.nOwned = mesh_.nNodes;
        addPlanes(heldBegin_, begin_);
        addPlanes(end_, heldEnd_);
        mesh_.firstGlobal = std::int64_t(begin_) * nodesPerPlane();
        mesh_.nGlobal = std::int64_t(cells_[0] + 1) * nodesPerPlane();
    }

    /// Kuhn's split: one simplex per order in which the axes are walked from one corner to the opposite one.
    void addCell(const Index& cell, bool isOwned)
    {
        std::array<int, 3> order{0, 1, 2};
        do
        {
            Index corner{0, 0, 0};
            for (int a = 0; a <= dim_; ++a)
            {
                if (a > 0)
                {
                    corner[order[a - 1]] = 1;
                }
                Index node = cell;
                for (int d = 0; d < dim_; ++d)
                {
                    const bool mirror = alternate_ && cell[d] % 2 == 1;
                    node[d] += mirror ? 1 - corner[d] : corner[d];
                }
                mesh_.elements.push_back(local(node));
            }
            mesh_.isOwnedElement.push_back(isOwned);
            ++mesh_.nElements;
        } while (std::next_permutation(order.begin(), order.begin() + dim_));
    }

    void addCells(int begin, int end)
    {
        for (int k = 0; k < std::max(cells_[2], 1); ++k)
        {
            for (int j = 0; j < cells_[1]; ++j)
            {
                for (int i = std::max(begin, 0); i < std::min(end, cells_[0]); ++i)
                {
                    addCell({i, j, k}, i >= begin_ && i < end_);
                }
            }
        }
    }

    /// Every simplex of a cell has nodes on both of its x planes, so the rings are layers of cells.
    void addElements()
    {
        addCells(begin_ - 1, end_);
        mesh_.nInnerElements = mesh_.nElements;
        addCells(begin_ - 2, begin_ - 1);
        addCells(end_, end_ + 1);
    }

    bool isOnPlane(int node, int direction, int index) const
    {
        std::int64_t number = mesh_.originalNode[node];
        for (int d = 0; d < direction; ++d)
        {
            number /= cells_[d] + 1;
        }
        return number % (cells_[direction] + 1) == index;
    }

    void addFaces(MeshPatch& patch, int direction, int index) const
    {
        for (int e = 0; e < mesh_.nElements; ++e)
        {
            const int* nodes = &mesh_.elements[e * (dim_ + 1)];
            for (int a = 0; a <= dim_; ++a)
            {
                const int* face = outwardFace(dim_, a);
                if (std::all_of(face, face + dim_, [&](int b) { return isOnPlane(nodes[b], direction, index); }))
                {
                    for (int b = 0; b < dim_; ++b)
                    {
                        patch.faceNodes.push_back(nodes[face[b]]);
                    }
                    patch.faceElement.push_back(e);
                    patch.isOwnedFace.push_back(mesh_.isOwnedElement[e]);
                }
            }
        }
    }

    void addPatches()
    {
        static const char* const names[6] = {"xMin", "xMax", "yMin", "yMax", "zMin", "zMax"};
        for (int side = 0; side < 2 * dim_; ++side)
        {
            MeshPatch patch;
            patch.name = names[side];
            patch.type = "patch";
            addFaces(patch, side / 2, side % 2 == 0 ? 0 : cells_[side / 2]);
            mesh_.patches.push_back(std::move(patch));
        }
    }

    int dim_, rank_ = 0, size_ = 1;
    Index cells_;
    std::array<double, 3> lower_, upper_;
    int begin_ = 0, end_ = 0;         // owned node planes
    int heldBegin_ = 0, heldEnd_ = 0; // node planes with the two rings
    double perturbation_ = 0;
    int seed_ = 0;
    bool alternate_ = false;
    std::vector<int> localNode_;
    SimplexMesh mesh_;
};

} // namespace

SimplexMesh makeBoxMesh(MPI_Comm comm, int dim, std::array<int, 3> cells, std::array<double, 3> lower,
    std::array<double, 3> upper, double perturbation, bool alternateDiagonals, int seed)
{
    return BoxBuilder(comm, dim, cells, lower, upper).build(perturbation, alternateDiagonals, seed);
}

} // namespace flotsam
