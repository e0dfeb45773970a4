# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# docker build -t viscera .          then docs/install.md: Container
# test/package/in_container_root runs the steps of the last stage where there is no container engine.

# What builds and tests; .github/workflows/ci.yml runs scripts/test in it.
FROM debian:12-slim AS tools
COPY scripts/install_packages /src/scripts/install_packages
RUN /src/scripts/install_packages core tests ros python bundle package && apt-get update && apt-get install -y --no-install-recommends git ca-certificates

FROM tools AS build
COPY . /src
RUN /src/scripts/package deb --out /packages

# What is used: the packages alone, no compiler.
FROM debian:12-slim
COPY --from=build /packages/ /packages/
RUN apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends /packages/*.deb libgl1-mesa-dri rosbash rviz novnc websockify x11vnc xvfb && rm -rf /packages /var/lib/apt/lists/*
RUN useradd --create-home trainee && install -d -o trainee /out
COPY scripts/packaging/container_demo /usr/local/bin/container_demo
USER trainee
WORKDIR /home/trainee
EXPOSE 6080
ENTRYPOINT ["/usr/local/bin/container_demo"]
