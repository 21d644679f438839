// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/elementRings.hpp"

#include "algebra/exchange.hpp"

#include <algorithm>

namespace flotsam
{

/// Per element: home, index, then key, owner and facePatch of each node; the coordinates of the nodes apart.
struct ElementRings::Batch
{
    std::vector<std::int64_t> numbers;
    std::vector<double> x;

    static int width(int dim) { return 2 + 3 * (dim + 1); }
    const std::int64_t* record(int i, int dim) const { return &numbers[static_cast<std::size_t>(i) * width(dim)]; }
    const double* coordinates(int i, int a, int dim) const { return &x[(static_cast<std::size_t>(i) * (dim + 1) + a) * dim]; }
};

ElementRings::ElementRings(const LocalSimplices& local, MPI_Comm comm)
    : dim(local.dim), x(local.x), elementNodes(local.elements), facePatch(local.facePatch), comm_(comm)
{
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &size);
    const std::vector<int> owner = lowestRankOfKeys(local.nodeKey, comm);
    nodes.resize(owner.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
        nodes[i] = {local.nodeKey[i], owner[i]};
    }
    elements.resize(elementNodes.size() / (dim + 1));
    for (std::size_t e = 0; e < elements.size(); ++e)
    {
        elements[e] = {rank, static_cast<int>(e)};
    }
    table_.append(local.nodeKey, 0);
}

bool ElementRings::hasOwnedNode(int element) const
{
    const auto first = elementNodes.begin() + static_cast<std::ptrdiff_t>(element) * (dim + 1);
    return std::any_of(first, first + dim + 1, [&](int node) { return nodes[node].owner == rank; });
}

void ElementRings::pack(int element, Batch& batch) const
{
    batch.numbers.push_back(elements[element].home);
    batch.numbers.push_back(elements[element].index);
    for (int a = 0; a <= dim; ++a)
    {
        const std::size_t k = static_cast<std::size_t>(element) * (dim + 1) + a;
        const int node = elementNodes[k];
        batch.numbers.insert(batch.numbers.end(), {nodes[node].key, nodes[node].owner, facePatch[k]});
        batch.x.insert(batch.x.end(), x.begin() + node * dim, x.begin() + (node + 1) * dim);
    }
}

void ElementRings::addFirstRing()
{
    std::vector<Batch> outgoing(size);
    std::vector<int> lastElement(size, -1);
    const int n = dim + 1, nOwn = static_cast<int>(elements.size());
    for (int e = 0; e < nOwn; ++e)
    {
        for (int a = 0; a < n; ++a)
        {
            const int owner = nodes[elementNodes[static_cast<std::size_t>(e) * n + a]].owner;
            if (owner != rank && lastElement[owner] != e)
            {
                lastElement[owner] = e;
                pack(e, outgoing[owner]);
            }
        }
    }
    exchange(outgoing);
}

void ElementRings::addSecondRing()
{
    // the owner of a node holds all its elements by now: ask it
    const int n = dim + 1, nHeld = static_cast<int>(elements.size());
    std::vector<char> isAsked(nodes.size(), 0);
    std::vector<std::vector<std::int64_t>> questions(size);
    for (int e = 0; e < nHeld; ++e)
    {
        for (int a = 0; a < n && hasOwnedNode(e); ++a)
        {
            const int node = elementNodes[static_cast<std::size_t>(e) * n + a];
            if (nodes[node].owner != rank && !isAsked[node])
            {
                isAsked[node] = 1;
                questions[nodes[node].owner].push_back(nodes[node].key);
            }
        }
    }
    const std::vector<std::vector<std::int64_t>> asked = exchangeLists(questions, comm_);

    std::vector<Batch> outgoing(size);
    std::vector<int> lastAsker(nodes.size(), -1);
    for (int r = 0; r < size; ++r)
    {
        for (const std::int64_t key : asked[r])
        {
            lastAsker[table_.find(key)] = r;
        }
        for (int e = 0; e < nHeld && !asked[r].empty(); ++e)
        {
            const auto first = elementNodes.begin() + static_cast<std::ptrdiff_t>(e) * n;
            if (elements[e].home != r && std::any_of(first, first + n, [&](int node) { return lastAsker[node] == r; }))
            {
                pack(e, outgoing[r]);
            }
        }
    }
    exchange(outgoing);
}

void ElementRings::exchange(const std::vector<Batch>& outgoing)
{
    std::vector<std::vector<std::int64_t>> numbers(size);
    std::vector<std::vector<double>> coordinates(size);
    for (int r = 0; r < size; ++r)
    {
        numbers[r] = outgoing[r].numbers;
        coordinates[r] = outgoing[r].x;
    }
    numbers = exchangeLists(numbers, comm_);
    coordinates = exchangeLists(coordinates, comm_);

    std::vector<Batch> batches(size);
    std::vector<std::pair<Element, std::pair<int, int>>> received; // element, (batch, record)
    for (int r = 0; r < size; ++r)
    {
        batches[r].numbers.swap(numbers[r]);
        batches[r].x.swap(coordinates[r]);
        const int count = static_cast<int>(batches[r].numbers.size()) / Batch::width(dim);
        for (int i = 0; i < count; ++i)
        {
            const std::int64_t* record = batches[r].record(i, dim);
            received.push_back({{static_cast<int>(record[0]), static_cast<int>(record[1])}, {r, i}});
        }
    }
    std::sort(received.begin(), received.end());

    std::vector<Element> held(elements);
    std::sort(held.begin(), held.end());
    std::vector<std::pair<int, int>> fresh;
    for (std::size_t k = 0; k < received.size(); ++k)
    {
        const Element& element = received[k].first;
        const bool isRepeated = k > 0 && element == received[k - 1].first;
        if (!isRepeated && !std::binary_search(held.begin(), held.end(), element))
        {
            elements.push_back(element);
            fresh.push_back(received[k].second);
        }
    }
    addNodes(batches, fresh);
}

void ElementRings::addNodes(const std::vector<Batch>& batches, const std::vector<std::pair<int, int>>& records)
{
    struct NewNode
    {
        Node node;
        const double* x;
    };
    std::vector<NewNode> candidates;
    for (const auto& [r, i] : records)
    {
        for (int a = 0; a <= dim; ++a)
        {
            const std::int64_t* data = batches[r].record(i, dim) + 2 + 3 * a;
            if (table_.find(data[0]) < 0)
            {
                candidates.push_back({{data[0], static_cast<int>(data[1])}, batches[r].coordinates(i, a, dim)});
            }
        }
    }
    std::sort(candidates.begin(), candidates.end(), [](const NewNode& p, const NewNode& q) { return p.node.key < q.node.key; });
    std::vector<std::int64_t> keys;
    const int first = static_cast<int>(nodes.size());
    for (const NewNode& candidate : candidates)
    {
        if (keys.empty() || candidate.node.key != keys.back())
        {
            keys.push_back(candidate.node.key);
            nodes.push_back(candidate.node);
            x.insert(x.end(), candidate.x, candidate.x + dim);
        }
    }
    table_.append(keys, first);
    for (const auto& [r, i] : records)
    {
        for (int a = 0; a <= dim; ++a)
        {
            const std::int64_t* data = batches[r].record(i, dim) + 2 + 3 * a;
            elementNodes.push_back(table_.find(data[0]));
            facePatch.push_back(static_cast<int>(data[2]));
        }
    }
}

} // namespace flotsam
