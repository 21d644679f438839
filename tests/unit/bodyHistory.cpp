// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/bodyHistory.hpp"

#include "io/hdf5File.hpp"
#include "support/near.hpp"
#include "support/temporaryFolder.hpp"

#include <doctest/doctest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>

using namespace flotsam;

namespace
{

TriSurface tetrahedron()
{
    TriSurface surface;
    surface.points = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    surface.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return surface;
}

std::vector<HistoryMember> members(int nBodies = 1)
{
    std::vector<HistoryMember> list;
    for (int i = 0; i < nBodies; ++i) list.push_back({"bar" + std::to_string(i), false, 0.06, 1e-4, tetrahedron()});
    list.push_back({"pipe", true, 0, 2e-4, tetrahedron()});
    return list;
}

/// Every number depends on time and member, so that a mix-up shows.
std::vector<BodyRecord> recordsAt(double t, std::size_t n)
{
    std::vector<BodyRecord> list(n);
    for (std::size_t m = 0; m < n; ++m)
    {
        BodyRecord& r = list[m];
        const double s = t + 100.0 * m;
        r.pose.position = Vec3(s, s + 1, s + 2);
        r.pose.orientation = Eigen::AngleAxisd(t, Vec3::UnitZ());
        r.motion.velocity = Vec3(s + 3, s + 4, s + 5);
        r.motion.angularVelocity = Vec3(0, 0, s + 6);
        r.fluidForce = Vec3(s + 7, s + 8, s + 9);
        r.fluidMoment = Vec3(s + 10, s + 11, s + 12);
        r.contactForce = Vec3(s + 13, s + 14, s + 15);
        r.contactMoment = Vec3(s + 16, s + 17, s + 18);
        r.peakContactForce = Vec3(s + 19, s + 20, s + 21);
        r.contacts = int(m) + 3;
        r.wetFraction = 0.25;
    }
    return list;
}

std::vector<double> read(const std::string& file, const std::string& path)
{
    return Hdf5File(file, Hdf5File::Mode::Read).readArray(path);
}

std::string text(const std::string& file)
{
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t count(const std::string& text, const std::string& part)
{
    std::size_t n = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

} // namespace

TEST_CASE("every series is found where it was put, with its unit")
{
    const TemporaryFolder folder("history");
    const std::string file = folder / "bodies.h5";
    {
        BodyHistory history(file, members(), 0);
        for (int i = 0; i <= 200; ++i) history.append(0.1 * i, recordsAt(0.1 * i, 2), {{"dt", 0.1}, {"massError", i * 1e-9}});
    }
    Hdf5File in(file, Hdf5File::Mode::Read);
    CHECK(in.rows("/bodies/bar0/position") == 201);
    CHECK(in.columns("/bodies/bar0/orientation") == 4);
    CHECK(in.columns("/bodies/bar0/wetFraction") == 1);
    CHECK(in.stringAttribute("/bodies/bar0/fluidMoment", "unit") == "N m");
    CHECK(in.stringAttribute("/structures/pipe/time", "unit") == "s");
    CHECK(in.realAttribute("/bodies/bar0", "mass") == 0.06);
    CHECK(in.readArray("/structures/pipe/time") == in.readArray("/run/time"));
    CHECK(in.readArray("/run/massError").at(200) == 200 * 1e-9);

    const auto expected = recordsAt(0.1 * 150, 2)[1];
    const auto at150 = [&](const std::string& name)
    { const auto all = in.readArray("/structures/pipe/" + name); return Vec3(all.data() + 3 * 150); };
    CHECK(at150("position") == expected.pose.position);
    CHECK(at150("velocity") == expected.motion.velocity);
    CHECK(at150("angularVelocity") == expected.motion.angularVelocity);
    CHECK(at150("fluidForce") == expected.fluidForce);
    CHECK(at150("fluidMoment") == expected.fluidMoment);
    CHECK(at150("contactForce") == expected.contactForce);
    CHECK(at150("contactMoment") == expected.contactMoment);
    CHECK(at150("peakContactForce") == expected.peakContactForce);
    CHECK(in.readArray("/structures/pipe/contacts").at(150) == 4);
    CHECK(in.readArray("/structures/pipe/wetFraction").at(150) == 0.25);
    const auto q = in.readArray("/structures/pipe/orientation");
    CHECK(q.at(600) == near(std::cos(7.5), 1e-14));
    CHECK(q.at(603) == near(std::sin(7.5), 1e-14));
}

TEST_CASE("a restart cuts off what it will compute again")
{
    const TemporaryFolder folder("historyRestart");
    const std::string file = folder / "bodies.h5";
    {
        BodyHistory history(file, members(), 0);
        for (int i = 0; i <= 10; ++i)
        {
            history.append(i, recordsAt(i, 2), {{"dt", 1.0}});
            if (i % 5 == 0) history.writeSurface(i, recordsAt(i, 2));
        }
    }
    {
        BodyHistory history(file, members(), 5);
        CHECK(read(file, "/run/time").size() == 6);
        CHECK(history.lastTime() == 5);
        CHECK(read(file, "/surface/time") == std::vector<double>{0, 5});
        history.append(5, recordsAt(500, 2), {});  // the state it starts from: known already
        history.append(5.5, recordsAt(5.5, 2), {{"repeats", 2.0}});
        history.writeSurface(5.5, recordsAt(5.5, 2));
    }
    CHECK(read(file, "/run/time") == std::vector<double>{0, 1, 2, 3, 4, 5, 5.5});
    CHECK(read(file, "/bodies/bar0/position").at(3 * 5) == 5);
    CHECK(read(file, "/surface/time") == std::vector<double>{0, 5, 5.5});
    const auto repeats = read(file, "/run/repeats"), dt = read(file, "/run/dt");
    CHECK(std::isnan(repeats.at(5)));
    CHECK(repeats.at(6) == 2);
    CHECK(std::isnan(dt.at(6)));

    CHECK(BodyHistory(file, members(), 8).lastTime() == 5.5);   // there is nothing from there to 8 s: of another run

    CHECK_THROWS_WITH_AS(BodyHistory(file, {members()[0]}, 5), doctest::Contains("holds /structures/pipe, which this case does not have"), std::runtime_error);
    BodyHistory(file, members(2), 0); // nothing in the old file is earlier: a new run
    CHECK(read(file, "/run/time").empty());
    CHECK(read(file, "/bodies/bar1/time").empty());
}

TEST_CASE("a run that is killed between two blocks leaves a readable file")
{
    const TemporaryFolder folder("historyKill");
    const std::string file = folder / "bodies.h5";
    const pid_t child = fork();
    if (child == 0)
    {
        BodyHistory history(file, members(), 0);
        for (int i = 0; i < 100; ++i) history.append(i, recordsAt(i, 2), {});
        history.flush();
        for (int i = 100; i < 110; ++i) history.append(i, recordsAt(i, 2), {});
        raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));
    CHECK(read(file, "/bodies/bar0/position").size() == 3 * 100);
}

TEST_CASE("a reader that keeps the file open does not disturb the run")
{
    const TemporaryFolder folder("historyReader");
    const std::string file = folder / "bodies.h5";
    BodyHistory history(file, members(), 0);
    history.append(0, recordsAt(0, 2), {});
    history.flush();

    int opened[2], finished[2];
    REQUIRE(pipe(opened) == 0);
    REQUIRE(pipe(finished) == 0);
    const pid_t child = fork();
    if (child == 0)
    {
        setenv("HDF5_USE_FILE_LOCKING", "TRUE", 1); // as h5py has it
        const Hdf5File reader(file, Hdf5File::Mode::Read);
        char byte = 1;
        const bool isDone = write(opened[1], &byte, 1) == 1 && ::read(finished[0], &byte, 1) == 1;
        _exit(isDone ? 0 : 1);
    }
    char byte = 0;
    REQUIRE(::read(opened[0], &byte, 1) == 1);
    history.append(1, recordsAt(1, 2), {});
    CHECK_NOTHROW(history.flush());
    REQUIRE(write(finished[1], &byte, 1) == 1);
    waitpid(child, nullptr, 0);
    CHECK(read(file, "/run/time").size() == 2);
}

TEST_CASE("of two runs in one folder one ends")
{
    const TemporaryFolder folder("twoRuns");
    const std::string file = folder / "bodies.h5";
    BodyHistory first(file, members(), 0);
    first.append(1, recordsAt(1, 2), {});
    first.flush();
    BodyHistory second(file, members(), 0);
    second.append(0.5, recordsAt(0.5, 2), {});
    second.append(1, recordsAt(1, 2), {});
    second.flush();
    first.append(2, recordsAt(2, 2), {});
    CHECK_THROWS_WITH(first.flush(), doctest::Contains("has 2 records, of which this run knows 1: another run writes into the same folder"));
}

TEST_CASE("the surface moves with its member")
{
    const TemporaryFolder folder("historySurface");
    const std::string file = folder / "bodies.h5";
    BodyHistory history(file, members(), 0);
    const double quarter = std::acos(0.0);
    history.writeSurface(0, recordsAt(0, 2));
    history.writeSurface(quarter, recordsAt(quarter, 2));

    const auto points = read(file, "/surface/points");
    REQUIRE(points.size() == 2 * 8 * 3);
    const Vec3 moved(points.data() + 3 * (8 + 4 + 1)); // second time, second member, point (1,0,0)
    const Vec3 expected = recordsAt(quarter, 2)[1].pose.position + Vec3::UnitY();
    CHECK((moved - expected).norm() < 1e-4);
    const auto member = read(file, "/surface/member");
    CHECK(member == std::vector<double>{0, 0, 0, 0, 1, 1, 1, 1});
    const auto velocity = read(file, "/surface/velocity");
    // v + omega x (0,1,0)
    CHECK(velocity.at(3 * (8 + 4 + 1)) == near((quarter + 103) - (quarter + 106), 1e-7));

    const std::string xdmf = text(folder / "bodies.xdmf");
    CHECK(count(xdmf, "<Grid Name=\"surface\"") == 2);
    CHECK(count(xdmf, "bodies.h5:/surface/points") == 2);
}

TEST_CASE("a body to come is marked, and its surface is a point at its place")
{
    const TemporaryFolder folder("historyAwaited");
    const std::string file = folder / "bodies.h5";
    {
        BodyHistory history(file, members(), 0);
        for (double t : {0.0, 1.0, 2.0})
        {
            std::vector<BodyRecord> records = recordsAt(t, 2);
            records[0].isAwaited = t < 2;
            records[1].hasLeft = t > 0;
            history.append(t, records, {});
            if (t > 0) history.writeSurface(t, records);
        }
    }
    CHECK(read(file, "/bodies/bar0/awaited") == std::vector<double>{1, 1, 0});
    CHECK(read(file, "/bodies/bar0/left") == std::vector<double>{0, 0, 0});
    CHECK(read(file, "/structures/pipe/left") == std::vector<double>{0, 1, 1});
    const auto points = read(file, "/surface/points"), velocity = read(file, "/surface/velocity");
    for (int i = 0; i < 4; ++i)
        for (int d = 0; d < 3; ++d)
        {
            CHECK(points.at(3 * i + d) == recordsAt(1, 2)[0].pose.position[d]); // double precision: maps' grids
            CHECK(velocity.at(3 * i + d) == near(recordsAt(1, 2)[0].motion.velocity[d], 1e-7));
        }
    const Vec3 first(points.data() + 3 * 8), second(points.data() + 3 * 9); // when it has come in
    CHECK((second - first).norm() == near(1, 2e-7));
}

TEST_CASE("bad names and files are refused")
{
    const TemporaryFolder folder("historyBad");
    auto list = members(2);
    list[1].name = "bar0";
    CHECK_THROWS_WITH_AS(BodyHistory(folder / "a.h5", list, 0), doctest::Contains("called bar0"), std::runtime_error);
    list[1].name = "a/b";
    CHECK_THROWS_WITH_AS(BodyHistory(folder / "a.h5", list, 0), doctest::Contains("a/b"), std::runtime_error);
    std::ofstream(folder / "b.h5") << "broken";
    CHECK_THROWS_WITH_AS(BodyHistory(folder / "b.h5", members(), 0), doctest::Contains("b.h5: cannot open the file (file signature not found): cut off, damaged"), std::runtime_error);
    CHECK_THROWS_WITH_AS(BodyHistory(folder / "b.h5", members(), 0), doctest::Contains("Rename or remove it"), std::runtime_error);
}

TEST_CASE("both groups are there, also without members")
{
    const TemporaryFolder folder("historyEmpty");
    const std::string file = folder / "bodies.h5";
    { BodyHistory history(file, {}, 0); }
    Hdf5File in(file, Hdf5File::Mode::Read);
    for (const char* group : {"/structures", "/bodies"})
    {
        CHECK(in.exists(group));
        CHECK(in.names(group).empty());
    }
}

TEST_CASE("appending is cheap" * doctest::may_fail()) // wall time on a shared machine
{
    const TemporaryFolder folder("historyCost");
    const auto list = members(29);
    BodyHistory history(folder / "bodies.h5", list, 0);
    const auto start = std::chrono::steady_clock::now();
    const int n = 1000;
    for (int i = 0; i < n; ++i) history.append(i, recordsAt(i, list.size()), {{"dt", 1.0}});
    history.flush();
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
    MESSAGE("ms per append of 30 members: " << spent.count() / n);
    CHECK(spent.count() / n < 1);
}

namespace
{

/// A line that turns with time, another that gets lost at 2 s.
std::vector<LineRecord> linesAt(double t)
{
    const Vec3 lost(5, 0, 0);
    return {{Vec3(t, 0, 0), Vec3(t, 1, t), 10 + t, 1, t < 1 ? 0 : -1}, {lost, t < 2 ? Vec3(6, 0, 0) : lost, t < 2 ? -1.0 : 0.0}};
}

const std::vector<std::string> lineNames{"mooring", "link"};

} // namespace

TEST_CASE("lines between bodies go on where a run does, and are there for ParaView")
{
    const TemporaryFolder folder("historyLines");
    const std::string file = folder / "bodies.h5";
    {
        BodyHistory history(file, members(), 0, lineNames);
        for (double t : {0.0, 1.0, 3.0})
        {
            history.append(t, recordsAt(t, 2), {});
            history.writeLines(t, linesAt(t));
        }
    }
    {
        BodyHistory history(file, members(), 1, lineNames);
        CHECK(read(file, "/restraints/time") == std::vector<double>{0, 1});
        history.writeLines(1, linesAt(7)); // known already
        history.writeLines(2, linesAt(2));
    }
    CHECK(read(file, "/restraints/time") == std::vector<double>{0, 1, 2});
    CHECK(read(file, "/restraints/tension") == std::vector<double>{10, -1, 11, -1, 12, 0});
    CHECK(read(file, "/restraints/members") == std::vector<double>{1, 0, -1, -1, 1, -1, -1, -1, 1, -1, -1, -1});
    const auto points = read(file, "/restraints/points");
    REQUIRE(points.size() == 3 * 2 * 2 * 3);
    CHECK(Vec3(points.data() + 3 * (4 + 1)) == Vec3(1, 1, 1));
    CHECK(Vec3(points.data() + 3 * (8 + 2)) == Vec3(points.data() + 3 * (8 + 3)));
    CHECK(read(file, "/restraints/lines") == std::vector<double>{0, 1, 2, 3});
    CHECK(Hdf5File(file, Hdf5File::Mode::Read).stringAttribute("/restraints", "names") == "mooring link");

    const std::string xdmf = text(folder / "restraints.xdmf");
    CHECK(count(xdmf, "<Time Value=") == 3);
    CHECK(count(xdmf, "TopologyType=\"Polyline\" NodesPerElement=\"2\" NumberOfElements=\"2\"") == 3);
    CHECK(count(xdmf, ">8 0 1 1 4 3<") == 1);   // points of the third time
    CHECK_THROWS_WITH_AS(BodyHistory(file, members(), 1, {"link", "mooring"}), doctest::Contains("holds other restraints (mooring link)"), std::runtime_error);
    CHECK_THROWS_WITH_AS(BodyHistory(file, members(), 1), doctest::Contains("holds other restraints"), std::runtime_error);
}

TEST_CASE("without restraints nothing of them is written, and a run may go on with some")
{
    const TemporaryFolder folder("historyNoLines");
    const std::string file = folder / "bodies.h5";
    {
        BodyHistory history(file, members(), 0);
        history.append(0, recordsAt(0, 2), {});
        history.writeLines(0, {});
    }
    CHECK_FALSE(Hdf5File(file, Hdf5File::Mode::Read).exists("/restraints"));
    CHECK(text(folder / "restraints.xdmf").empty());
    BodyHistory history(file, members(), 1, lineNames);
    history.writeLines(1, linesAt(1));
    CHECK(read(file, "/restraints/time") == std::vector<double>{1});
    CHECK(count(text(folder / "restraints.xdmf"), "<Time Value=") == 1);
}
