// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/sweep_table.h"
#include "viscera/math/error.h"

#ifdef VISCERA_HDF5
#include <hdf5.h>

#include <cmath>
#include <cstdlib>
#endif

namespace viscera::cli {

#ifndef VISCERA_HDF5

bool hasHdf5() {
  return false;
}

void writeHdf5(const SweepTable& /*table*/, const std::string& path) {
  throw Error(path + ": this viscera was built without HDF5");
}

#else

namespace {

/// Something of HDF5's that is closed when this ends.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close, const std::string& path) : id_(id), close_(close) {
    if (id_ < 0) throw Error(path + ": HDF5 cannot write it");
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close_(id_); }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

void require(bool well, const std::string& path) {
  if (!well) throw Error(path + ": HDF5 cannot write it");
}

hid_t textType() {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

void addUnit(hid_t dataset, const std::string& unit, const std::string& path) {
  if (unit.empty()) return;
  const Handle type(textType(), H5Tclose, path), space(H5Screate(H5S_SCALAR), H5Sclose, path);
  const Handle attribute(H5Acreate2(dataset, "unit", type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, path);
  const char* text = unit.c_str();
  require(H5Awrite(attribute, type, &text) >= 0, path);
}

void addColumn(hid_t place, const SweepTable::Column& column, const std::string& path) {
  const hsize_t runs = column.cells.size();
  const Handle space(H5Screate_simple(1, &runs, nullptr), H5Sclose, path);
  const Handle type(column.number ? H5Tcopy(H5T_NATIVE_DOUBLE) : textType(), H5Tclose, path);
  const Handle dataset(H5Dcreate2(place, column.name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       H5Dclose, path);
  std::vector<double> numbers;
  std::vector<const char*> texts;
  for (const std::string& cell : column.cells) {
    if (column.number)
      numbers.push_back(cell.empty() ? std::nan("") : std::strtod(cell.c_str(), nullptr));
    else
      texts.push_back(cell.c_str());
  }
  const void* values = column.number ? static_cast<const void*>(numbers.data()) : texts.data();
  require(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0, path);
  if (column.number) addUnit(dataset, unitOf(column.name), path);
}

}  // namespace

bool hasHdf5() {
  return true;
}

void writeHdf5(const SweepTable& table, const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // what goes wrong is told once, by the error thrown
  const Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, path);
  const Handle keys(H5Gcreate2(file, "keys", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path);
  const Handle metrics(H5Gcreate2(file, "metrics", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path);
  for (const SweepTable::Column& column : table.columns) {
    const bool is_key = column.of == SweepTable::Of::kKeys, is_metric = column.of == SweepTable::Of::kMetrics;
    addColumn(is_key ? keys : is_metric ? metrics : file, column, path);
  }
  require(H5Fflush(file, H5F_SCOPE_LOCAL) >= 0, path);
}

#endif

}  // namespace viscera::cli
