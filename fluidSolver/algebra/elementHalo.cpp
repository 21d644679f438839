// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/elementHalo.hpp"

#include "algebra/exchange.hpp"
#include "algebra/nodeNumbering.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace flotsam
{

namespace
{

/// What an element is called on any rank: the numbers of its nodes, ascending.
using Name = std::array<std::int64_t, 4>;

Name nameOf(const SimplexMesh& mesh, int element)
{
    const int n = mesh.dim + 1;
    Name name{};
    for (int a = 0; a < n; ++a) name[a] = mesh.originalNode[mesh.elements[std::size_t(element)*n + a]];
    std::sort(name.begin(), name.begin() + n);
    return name;
}

int lowestOwner(const SimplexMesh& mesh, int element)
{
    const int n = mesh.dim + 1, *nodes = &mesh.elements[std::size_t(element)*n];
    int lowest = mesh.nodeOwner[nodes[0]];
    for (int a = 1; a < n; ++a) lowest = std::min(lowest, mesh.nodeOwner[nodes[a]]);
    return lowest;
}

/// By name among the elements of an owned node that it has.
int findElement(const SimplexMesh& mesh, const NodeGraph& graph, const KeyTable& owned, const Name& name)
{
    for (int a = 0; a <= mesh.dim; ++a)
    {
        const int node = owned.find(name[a]);
        for (int k = node < 0 ? 0 : graph.nodeElementStart[node]; node >= 0 && k < graph.nodeElementStart[node + 1]; ++k)
            if (nameOf(mesh, graph.nodeElement[k]) == name) return graph.nodeElement[k];
    }
    throw std::logic_error("ElementHalo: another process asks for an element that this one should have");
}

} // namespace

ElementHalo::ElementHalo(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo)
:   comm_(halo.comm()), send_(halo.size()), receive_(halo.size())
{
    if (halo.size() == 1) return;
    const int n = mesh.dim + 1;
    std::vector<std::vector<std::int64_t>> questions(halo.size());
    for (int e = mesh.nInnerElements; e < mesh.nElements; ++e)
    {
        const int rank = lowestOwner(mesh, e);
        const Name name = nameOf(mesh, e);
        receive_[rank].push_back(e);
        questions[rank].insert(questions[rank].end(), name.begin(), name.begin() + n);
    }
    questions = exchangeLists(questions, comm_);
    KeyTable owned;
    owned.append({mesh.originalNode.begin(), mesh.originalNode.begin() + mesh.nOwned}, 0);
    for (std::size_t r = 0; r < questions.size(); ++r)
        for (std::size_t k = 0; k < questions[r].size(); k += n)
        {
            Name name{};
            std::copy_n(&questions[r][k], n, name.begin());
            send_[r].push_back(findElement(mesh, graph, owned, name));
        }
}

void ElementHalo::update(std::vector<double>& values, int width) const
{
    if (send_.size() == 1) return;
    std::vector<std::vector<double>> lists(send_.size());
    for (std::size_t r = 0; r < send_.size(); ++r)
    {
        lists[r].reserve(send_[r].size()*width);
        for (const int e : send_[r]) lists[r].insert(lists[r].end(), &values[std::size_t(e)*width], &values[std::size_t(e)*width] + width);
    }
    lists = exchangeLists(lists, comm_);
    for (std::size_t r = 0; r < receive_.size(); ++r)
        for (std::size_t k = 0; k < receive_[r].size(); ++k)
            std::copy_n(&lists[r][k*width], width, &values[std::size_t(receive_[r][k])*width]);
}

} // namespace flotsam
