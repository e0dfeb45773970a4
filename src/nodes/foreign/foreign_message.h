// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

// Messages of packages that Debian lacks, so that neither their packages nor a rebuild are needed to talk to their
// drivers: what a message is on the wire is its fields in order, its name, and the sum of its definition.

/// Makes a struct a message of ROS; its fields(stream, message) gives its fields to stream.next, in order. Outside of
/// all namespaces.
#define VISCERA_FOREIGN_MESSAGE(STRUCT, NAME, MD5, DEFINITION)     \
  namespace ros {                                                  \
  namespace message_traits {                                       \
  template <>                                                      \
  struct IsMessage<STRUCT> : TrueType {};                          \
  template <>                                                      \
  struct MD5Sum<STRUCT> {                                          \
    static const char* value() { return MD5; }                     \
    static const char* value(const STRUCT&) { return MD5; }        \
  };                                                               \
  template <>                                                      \
  struct DataType<STRUCT> {                                        \
    static const char* value() { return NAME; }                    \
    static const char* value(const STRUCT&) { return NAME; }       \
  };                                                               \
  template <>                                                      \
  struct Definition<STRUCT> {                                      \
    static const char* value() { return DEFINITION; }              \
    static const char* value(const STRUCT&) { return DEFINITION; } \
  };                                                               \
  }                                                                \
  namespace serialization {                                        \
  template <>                                                      \
  struct Serializer<STRUCT> {                                      \
    template <typename Stream, typename T>                         \
    static void allInOne(Stream& stream, T message) {              \
      STRUCT::fields(stream, message);                             \
    }                                                              \
    ROS_DECLARE_ALLINONE_SERIALIZER                                \
  };                                                               \
  }                                                                \
  }
