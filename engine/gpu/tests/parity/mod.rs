//! Parity: each kernel against its reference on the CPU, whole steps against `Cloth::step`, and what happens when the device
//! fails. `scene::offload` says where these tests can run: with CI=true a machine without an adapter fails them.

mod backend;
mod device;
mod drawn;
mod kernels;
mod scene;
mod skin;
mod steps;
