//! Reports why no test plays a recording of OrbbecSDK in a camera's place.

/// Its recorder takes a device that is connected, its file is of its own kind, and no recording lies with the shared data.
pub fn say_what_is_missing() {
    eprintln!("did not run: OrbbecSDK records from a connected camera alone, and there is no recording here to play");
}
