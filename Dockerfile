# Image with the program and its data: docker build -t grainbench . && docker run --rm -v "$PWD:/work" grainbench run squash
FROM rust:1.95-slim-bookworm AS build
WORKDIR /source
COPY . .
RUN cargo build --release --locked \
    && mkdir -p /out/bin /out/share/grainbench \
    && cp target/release/grainbench /out/bin/ \
    && find cases reference -type f ! -name '*.rs' ! -path 'reference/tests/*' -exec cp --parents -t /out/share/grainbench {} +

# Solvers in Python and C++ need these programs.
FROM debian:bookworm-slim
RUN apt-get update \
    && apt-get install --yes --no-install-recommends curl ca-certificates g++ make python3 python3-numpy \
    && rm -rf /var/lib/apt/lists/*
COPY --from=build /out/ /usr/local/
WORKDIR /work
ENTRYPOINT ["grainbench"]
