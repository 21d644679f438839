// SPDX-License-Identifier: GPL-3.0-or-later
/// What the options of algebra/needlessWork.hpp do leaves answers as they are. The others, over whole steps: benchmarks/speed/skipping.
#include "algebra/needlessWork.hpp"
#include "support/coverScene.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"
#include "support/transportScene.hpp"

#include <doctest/doctest.h>
#include <petscsys.h>

#include <memory>
#include <string>

using namespace flotsam;

namespace
{

/// What make() returns with the option of that work.
template<class Make>
auto withOption(const std::string& work, Make make)
{
    usePetsc();
    const std::string option = "-needless_" + work;
    PetscOptionsSetValue(nullptr, option.c_str(), nullptr);
    REQUIRE(doesNeedless(work.c_str()));
    auto made = make();
    PetscOptionsClearValue(nullptr, option.c_str());
    REQUIRE(!doesNeedless(work.c_str()));
    return made;
}

} // namespace

TEST_CASE("needless cuts")
{
    for (const int dim : {2, 3})
    {
        const CoverScene scene(dim, dim == 2 ? 40 : 16);
        const auto make = [&] { return std::make_unique<CoverBuilder>(scene.mesh, scene.graph, scene.halo); };
        const std::unique_ptr<CoverBuilder> builders[] = {make(), withOption("cut", make)};
        for (const double time : {0., 1., 2.})
        {
            const std::vector<Solid> solids{makeSolid(makeCylinder({0, 0, -0.6}, {0, 0, 0.6}, 0.2), {-0.45, 0.1, 0}, Solid::Kind::Fixed),
                makeSolid(makeBox(Vec3::Zero(), {0.5, 0.3, 1}), {0.08 + 0.05*time, 0.11, 0.02}, Solid::Kind::Free)};
            const Cover &cover = builders[0]->build(solids), &needless = builders[1]->build(solids);
            CHECK(cover.state == needless.state);
            CHECK(cover.isActiveNode == needless.isActiveNode);
            REQUIRE(cover.cuts.size() == needless.cuts.size());
            REQUIRE(cover.cuts.size() > 0);
            double worst = 0;
            for (const CutElement& cut : cover.cuts)
                worst = std::max(worst, std::abs(cut.volume - needless.cuts[needless.cutIndex[cut.element]].volume)/scene.mesh.volume[cut.element]);
            CHECK(worst < 1e-13);
            for (std::size_t s = 0; s < solids.size(); ++s) CHECK(cover.solidArea[s] == near(needless.solidArea[s], 1e-12));
        }
    }
}

TEST_CASE("needless transport")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 32 : 12;
        const auto make = [&] { return std::make_unique<TransportScene>(MPI_COMM_WORLD, dim, n, 0.35, dim == 2 ? vortexField() : deformationField()); };
        const std::unique_ptr<TransportScene> scenes[] = {make(), withOption("transport", make)};
        for (const auto& scene : scenes)
        {
            scene->fill(disc({0.5, dim == 2 ? 0.75 : 0.5, 0.5}, 0.2, dim));
            for (int k = 0; k < 5; ++k) scene->advance(1.5/(n*scene->fastest), 1);  // several parts a step
        }
        double worst = 0;
        for (int i = 0; i < scenes[0]->mesh.nNodes; ++i) worst = std::max(worst, std::abs(scenes[0]->alpha[i] - scenes[1]->alpha[i]));
        CHECK(scenes[0]->halo.max(worst) < 1e-12);
    }
}
