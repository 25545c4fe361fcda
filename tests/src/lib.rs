//! The tests of the house live in `tests/`; this library holds what they share.
