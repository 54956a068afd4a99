//! The examples of the repository, built against the package (see `Cargo.toml`).
