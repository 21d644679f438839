// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/xdmfParts.hpp"

#include <cstdio>
#include <fstream>
#include <iomanip>
#include <stdexcept>

namespace flotsam
{

std::ostream& operator<<(std::ostream& out, const XdmfSlab& s)
{
    return out << "<DataItem ItemType=\"HyperSlab\" Dimensions=\"" << s.count << ' ' << s.columns << "\" Type=\"HyperSlab\">"
        << "<DataItem Dimensions=\"3 2\" Format=\"XML\">" << s.first << " 0 1 1 " << s.count << ' ' << s.columns << "</DataItem>"
        << "<DataItem Dimensions=\"" << s.total << ' ' << s.columns << "\" NumberType=\"" << s.type << "\" Precision=\"" << s.precision << "\" Format=\"HDF\">"
        << s.dataset << "</DataItem></DataItem>";
}

std::string folderOf(const std::string& file)
{
    const auto slash = file.rfind('/');
    return slash == std::string::npos ? "" : file.substr(0, slash + 1);
}

std::string fileNameOf(const std::string& file) { return file.substr(folderOf(file).size()); }

void writeXdmfFile(const std::string& name, const std::string& collection, const std::function<void(std::ostream&)>& writeTimes)
{
    std::ofstream out(name + ".tmp");
    out << std::setprecision(12) << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\"><Domain>\n"
        << "<Grid Name=\"" << collection << "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
    writeTimes(out);
    out << "</Grid>\n</Domain></Xdmf>\n";
    out.close();
    if (!out || std::rename((name + ".tmp").c_str(), name.c_str()) != 0) throw std::runtime_error(name + ": cannot write the file");
}

} // namespace flotsam
