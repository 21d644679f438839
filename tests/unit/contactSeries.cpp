// SPDX-License-Identifier: GPL-3.0-or-later
/// Contacts in the history file.
#include "io/bodyHistory.hpp"

#include "io/hdf5File.hpp"
#include "support/temporaryFolder.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <iterator>

using namespace flotsam;

namespace
{

std::vector<HistoryMember> members()
{
    TriSurface surface;
    surface.points = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    surface.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return {{"bar", false, 0.06, 1e-4, surface}};
}

std::vector<double> read(const std::string& file, const std::string& path) { return Hdf5File(file, Hdf5File::Mode::Read).readArray(path); }

std::string text(const std::string& file)
{
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t count(const std::string& text, const std::string& part)
{
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

/// So many contacts at time t, of a force t + k.
std::vector<ContactRecord> contactsAt(double t, int n)
{
    std::vector<ContactRecord> contacts(n);
    for (int k = 0; k < n; ++k)
        contacts[k] = {k, k + 1, Vec3(t, k, 0), Vec3(0, 0, t + k), 1e-5*(k + 1), k + 2, {Vec3(t, 0, 0), Vec3(t, k, 0), Vec3(t, 0, 1)}};
    return contacts;
}

} // namespace

TEST_CASE("contacts go on where a run does, as many as there are at each time, and are there for ParaView")
{
    const TemporaryFolder folder("historyContacts");
    const std::string file = folder / "bodies.h5";
    {
        BodyHistory history(file, members(), 0, {}, {"bed", "side"});
        for (const auto& [t, n] : {std::pair<double, int>{0, 0}, {1, 2}, {3, 5}})
        {
            history.append(t, std::vector<BodyRecord>(1), {});
            history.writeContacts(t, contactsAt(t, n), Vec3(7, 0, 0));
        }
    }
    CHECK(read(file, "/contacts/begin") == std::vector<double>{0, 0, 2, 7});
    {
        BodyHistory history(file, members(), 1, {}, {"bed", "side"});
        CHECK(read(file, "/contacts/begin") == std::vector<double>{0, 0, 2});
        CHECK(read(file, "/contacts/line").size() == 2*3*3);
        history.writeContacts(1, contactsAt(1, 4), Vec3(8, 0, 0)); // known already
        history.writeContacts(2, contactsAt(2, 3), Vec3(8, 0, 0));
    }
    CHECK(read(file, "/contacts/time") == std::vector<double>{0, 1, 2});
    CHECK(read(file, "/contacts/begin") == std::vector<double>{0, 0, 2, 5});
    CHECK(read(file, "/contacts/first") == std::vector<double>{0, 1, 0, 1, 2});
    CHECK(read(file, "/contacts/second") == std::vector<double>{1, 2, 1, 2, 3});
    CHECK(read(file, "/contacts/spheres") == std::vector<double>{2, 3, 2, 3, 4});
    const auto force = read(file, "/contacts/force");
    REQUIRE(force.size() == 5*3);
    CHECK(Vec3(force.data() + 3*4) == Vec3(0, 0, 4));
    CHECK(Hdf5File(file, Hdf5File::Mode::Read).stringAttribute("/contacts", "walls") == "bed side");

    const std::string xdmf = text(folder / "contacts.xdmf");
    CHECK(count(xdmf, "<Time Value=") == 3);
    CHECK(count(xdmf, "TopologyType=\"Polyvertex\"") == 1);
    CHECK(count(xdmf, ">8.000000 0.000000 0.000000<") == 1);
    CHECK(count(xdmf, ">6 0 1 1 9 3<") == 1);   // lines' points of the third time
    CHECK_THROWS_WITH_AS(BodyHistory(file, members(), 1, {}, {"bed"}), doctest::Contains("its contacts are with other walls (bed side; now: bed)"), std::runtime_error);
}

TEST_CASE("a run without contacts goes on with them")
{
    const TemporaryFolder folder("historyNoContacts");
    const std::string file = folder / "bodies.h5";
    {
        BodyHistory history(file, members(), 0, {}, {"bed"});
        history.append(0, std::vector<BodyRecord>(1), {});
    }
    CHECK_FALSE(Hdf5File(file, Hdf5File::Mode::Read).exists("/contacts"));
    BodyHistory history(file, members(), 1, {}, {"bed"});
    history.writeContacts(1, contactsAt(1, 2), Vec3::Zero());
    CHECK(read(file, "/contacts/begin") == std::vector<double>{0, 2});
    CHECK(count(text(folder / "contacts.xdmf"), "<Time Value=") == 1);
}
