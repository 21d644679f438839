// SPDX-License-Identifier: GPL-3.0-or-later
/// What a no-slip wall takes where an unresolved layer separates: nothing of streams that keep their speed or gain some, a share of the deceleration of others.
#include "equations/layerSeparation.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <array>

using namespace flotsam;

namespace
{

/// A triangle or tetrahedron with corners off the axes; velocity a0 + G x.
template<int D>
struct Element
{
    double gradN[(D + 1)*D], nodal[(D + 1)*D], mean[D];

    Element(const Eigen::Matrix<double, D, 1>& a0, const Eigen::Matrix<double, D, D>& g)
    {
        Eigen::Matrix<double, D, D> edges;
        std::array<Eigen::Matrix<double, D, 1>, D + 1> x;
        for (int a = 0; a <= D; ++a)
            for (int d = 0; d < D; ++d) x[a][d] = 0.01*(a == d + 1) + 0.002*((3*a + 2*d) % 5);
        for (int a = 0; a < D; ++a) edges.row(a) = (x[a + 1] - x[0]).transpose();
        const Eigen::Matrix<double, D, D> inverse = edges.inverse();
        Eigen::Matrix<double, D, 1> centre = Eigen::Matrix<double, D, 1>::Zero();
        for (int a = 0; a <= D; ++a) centre += x[a]/(D + 1);
        for (int d = 0; d < D; ++d)
        {
            gradN[d] = 0;
            for (int a = 0; a < D; ++a)
            {
                gradN[(a + 1)*D + d] = inverse(d, a);
                gradN[d] -= inverse(d, a);
            }
        }
        for (int a = 0; a <= D; ++a)
        {
            const Eigen::Matrix<double, D, 1> u = a0 + g*(x[a] - centre);
            for (int d = 0; d < D; ++d) nodal[a*D + d] = u[d];
        }
        for (int d = 0; d < D; ++d) mean[d] = a0[d];
    }

    double hold(double mu, const Eigen::Matrix<double, D, 1>& rate = Eigen::Matrix<double, D, 1>::Zero()) const
    {
        return separationHold<D>(0.3, 1000, mu, 0.01, mean, nodal, rate.data(), gradN);
    }
};

constexpr double thin = 1e-9;   // [Pa s]: layers far thinner than the element

template<int D>
void checkStreams()
{
    using Vector = Eigen::Matrix<double, D, 1>;
    using Matrix = Eigen::Matrix<double, D, D>;
    Matrix turn = Matrix::Identity();
    turn.template topLeftCorner<2, 2>() = Eigen::Rotation2Dd(0.7).toRotationMatrix();
    const Vector a = turn*(0.5*Vector::Unit(0));
    const auto turned = [&](const Matrix& g) -> Matrix { return turn*g*turn.transpose(); };
    Matrix stretch = -Matrix::Identity(), shear = Matrix::Zero();
    stretch.diagonal().setConstant(1.0/(D - 1));
    stretch(0, 0) = -1;                 // slows down along itself by 1/s, free of divergence
    shear(0, 1) = 100;
    CHECK(Element<D>(a, Matrix::Zero()).hold(thin) == 0);
    CHECK(Element<D>(a, turned(shear)).hold(thin) == 0);            // along a plane wall
    CHECK(Element<D>(a, turned(-stretch)).hold(thin) == 0);         // gains speed
    CHECK(Element<D>(Vector::Zero(), turned(stretch)).hold(thin) == 0);
    // share rho (h k - 0.02 |a|)
    CHECK(Element<D>(a, turned(3*stretch)).hold(thin) == near(0.3*1000*(0.01*3 - 0.02*0.5), 1e-10));
    CHECK(Element<D>(a, turned(3*stretch + shear)).hold(thin) == near(0.3*1000*(0.01*3 - 0.02*0.5), 1e-10));
    CHECK(Element<D>(a, turned(0.9*stretch)).hold(thin) == 0);      // less than a fiftieth over the element
    // half where the stream changes as fast in time as along itself (beyond the fiftieth), whatever changes across it
    const double slowing = 0.5*3 - 0.02*0.5*0.5/0.01;   // [m/s^2]
    CHECK(Element<D>(a, turned(3*stretch)).hold(thin, turn*(slowing*Vector::Unit(0) + 7*Vector::Unit(1))) == near(0.5*0.3*1000*(0.01*3 - 0.02*0.5), 1e-10));
    CHECK(Element<D>(a, turned(3*stretch)).hold(thin, turn*(-slowing*Vector::Unit(0))) == near(0.5*0.3*1000*(0.01*3 - 0.02*0.5), 1e-10));
    // half where the element's Reynolds number is 100, next to nothing at 10
    CHECK(Element<D>(a, turned(3*stretch)).hold(1000*0.5*0.01/100) == near(0.5*0.3*1000*(0.01*3 - 0.02*0.5), 1e-10));
    CHECK(Element<D>(a, turned(3*stretch)).hold(1000*0.5*0.01/10) < 0.011*0.3*1000*(0.01*3 - 0.02*0.5));
}

} // namespace

TEST_CASE("2D streams along a wall") { checkStreams<2>(); }
TEST_CASE("3D streams along a wall") { checkStreams<3>(); }
