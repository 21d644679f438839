// SPDX-License-Identifier: GPL-3.0-or-later
/// The history of a run that goes on with more bodies, structures and restraints than it began with.
#include "io/bodyHistory.hpp"

#include "io/hdf5File.hpp"
#include "support/temporaryFolder.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <iterator>

using namespace flotsam;

namespace
{

/// `corners` - 2 triangles.
HistoryMember member(const std::string& name, bool isStructure, int corners, const Vec3& start = Vec3::Zero())
{
    HistoryMember m;
    m.name = name;
    m.isStructure = isStructure;
    m.mass = isStructure ? 0 : 1;
    for (int k = 0; k < corners; ++k) m.surface.points.push_back(Vec3(k, k % 2, 0));
    for (int k = 2; k < corners; ++k) m.surface.triangles.push_back({k - 2, k - 1, k});
    m.start.position = start;
    return m;
}

std::vector<BodyRecord> recordsAt(double t, std::size_t n)
{
    std::vector<BodyRecord> records(n);
    for (std::size_t k = 0; k < n; ++k)
    {
        records[k].pose.position = Vec3(t, 10.0*double(k), 0);
        records[k].motion.velocity = Vec3(1 + double(k), 0, 0);
        records[k].contactForce = Vec3(0, 1 + double(k), t);
    }
    return records;
}

std::vector<double> read(const std::string& file, const std::string& path) { return Hdf5File(file, Hdf5File::Mode::Read).readArray(path); }

/// From these members to points of space.
std::vector<LineRecord> lines(const std::vector<int>& fastenedTo, double t)
{
    std::vector<LineRecord> list(fastenedTo.size());
    for (std::size_t k = 0; k < list.size(); ++k) list[k] = {Vec3(t, 0, 0), Vec3(t, 1 + double(k), 0), 100*t + double(k), fastenedTo[k], -1};
    return list;
}

const std::vector<HistoryMember> few{member("pier", true, 3), member("old", false, 4)},
    more{member("pier", true, 3), member("rack", true, 3, Vec3(5, 5, 5)), member("early", false, 5, Vec3(7, 8, 9)), member("old", false, 4)};

/// Times 0, 1, 2 of few, with contacts of old and pier, and of old and a wall.
void writeFew(const std::string& file)
{
    BodyHistory history(file, few, 0, {"tie"}, {"bed"});
    for (double t : {0.0, 1.0, 2.0})
    {
        history.append(t, recordsAt(t, 2), {{"dt", 1.0}});
        history.writeSurface(t, recordsAt(t, 2));
        history.writeLines(t, lines({1}, t));
        ContactRecord pier, bed;
        pier.first = bed.first = 1;
        pier.second = 0;
        bed.second = 2;
        history.writeContacts(t, {pier, bed}, Vec3::Zero());
    }
}

} // namespace

TEST_CASE("members that come late are awaited at their start in the records before, and those before keep theirs")
{
    const TemporaryFolder folder("historyAdded");
    const std::string file = folder / "bodies.h5";
    writeFew(file);
    const std::vector<double> old = read(file, "/bodies/old/contactForce");
    {
        BodyHistory history(file, more, 1, {"new", "tie"}, {"bed"});
        history.append(1.5, recordsAt(1.5, 4), {{"dt", 0.5}});
        history.writeSurface(1.5, recordsAt(1.5, 4));
        history.writeLines(1.5, lines({2, 3}, 1.5));
        ContactRecord both;
        both.first = 2;
        both.second = 4;
        history.writeContacts(1.5, {both}, Vec3::Zero());
    }
    CHECK(read(file, "/run/time") == std::vector<double>{0, 1, 1.5});
    CHECK(read(file, "/bodies/early/time") == read(file, "/run/time"));
    CHECK(read(file, "/bodies/early/awaited") == std::vector<double>{1, 1, 0});
    CHECK(read(file, "/structures/rack/awaited") == std::vector<double>{1, 1, 0});
    CHECK(read(file, "/bodies/old/awaited") == std::vector<double>{0, 0, 0});
    CHECK(read(file, "/bodies/early/position") == std::vector<double>{7, 8, 9, 7, 8, 9, 1.5, 20, 0});
    CHECK(read(file, "/bodies/early/orientation")[0] == 1);
    const std::vector<double> force = read(file, "/bodies/old/contactForce");
    CHECK(std::vector<double>(force.begin(), force.begin() + 6) == std::vector<double>(old.begin(), old.begin() + 6));
    CHECK(force[8] == 1.5);
    const Hdf5File in(file, Hdf5File::Mode::Read);
    CHECK(in.integerAttribute("/bodies", "members") == 2);
    CHECK(in.integerAttribute("/bodies/old", "member") == 3);
    CHECK(in.integerAttribute("/bodies/early", "member") == 2);
    CHECK(in.readArray("/contacts/first") == std::vector<double>{3, 3, 3, 3, 2});
    CHECK(in.readArray("/contacts/second") == std::vector<double>{0, 4, 0, 4, 4});
    CHECK(in.readArray("/restraints/tension") == std::vector<double>{0, 0, 0, 100, 150, 151});
    CHECK(in.readArray("/restraints/members") == std::vector<double>{-1, -1, 3, -1, -1, -1, 3, -1, 2, -1, 3, -1});
    const std::vector<double> ends = in.readArray("/restraints/points");
    REQUIRE(ends.size() == 3*4*3);
    CHECK(Vec3(&ends[12]) == Vec3(&ends[15]));   // the new one is not there at 1 s
    CHECK(Vec3(&ends[21]) == Vec3(1, 1, 0));     // the old one's other end
    CHECK(in.stringAttribute("/restraints", "names") == "new tie");
    CHECK_FALSE(std::ifstream(file + ".tmp"));
}

TEST_CASE("surfaces of those that come late are points at their start, and the others stay")
{
    const TemporaryFolder folder("historyAddedSurface");
    const std::string file = folder / "bodies.h5";
    writeFew(file);
    const std::vector<double> before = read(file, "/surface/points");
    BodyHistory(file, more, 2, {"tie"}, {"bed"});
    const std::size_t nFew = 3 + 4, nMore = 3 + 3 + 5 + 4;
    const std::vector<double> points = read(file, "/surface/points"), velocity = read(file, "/surface/velocity"), force = read(file, "/surface/contactForce");
    REQUIRE(points.size() == 3*3*nMore);
    for (std::size_t t = 0; t < 3; ++t)
    {
        const double *now = &points[3*t*nMore], *was = &before[3*t*nFew];
        CHECK(std::equal(was, was + 9, now));
        CHECK(std::equal(was + 9, was + 3*nFew, now + 3*(3 + 3 + 5)));
        CHECK(Vec3(now + 9) == Vec3(5, 5, 5));
        CHECK(Vec3(now + 3*(3 + 3 + 4)) == Vec3(7, 8, 9));
        CHECK(Vec3(&velocity[3*(t*nMore + 4)]).norm() == 0);
        CHECK(Vec3(&force[3*(t*7 + 1 + 1 + 3)])[1] == 2);     // first triangle of `old`
    }
    CHECK(read(file, "/surface/member") == std::vector<double>{0, 1, 2, 2, 2, 3, 3});
    CHECK(read(file, "/surface/triangles").size() == 3*7);
    CHECK(read(file, "/surface/triangles").back() == nMore - 1);
}

TEST_CASE("a history of no member at all gets some; one damaged is refused and stays")
{
    const TemporaryFolder folder("historyAddedToNone");
    const std::string file = folder / "bodies.h5";
    {
        BodyHistory history(file, {}, 0);
        history.append(0, {}, {});
        history.append(1, {}, {});
    }
    {
        BodyHistory history(file, more, 1);
        history.append(2, recordsAt(2, 4), {});
        history.writeSurface(2, recordsAt(2, 4));
    }
    CHECK(read(file, "/bodies/early/awaited") == std::vector<double>{1, 1, 0});
    CHECK(read(file, "/surface/time") == std::vector<double>{2});
    std::ofstream(file, std::ios::trunc) << "no HDF5";
    CHECK_THROWS_WITH_AS(BodyHistory(file, more, 1), doctest::Contains("cut off, damaged"), std::runtime_error);
}
