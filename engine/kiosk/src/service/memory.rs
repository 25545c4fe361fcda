//! Locked memory: no step waits for a page, and no data of a shopper is ever swapped to a disk.

use crate::error::KioskError;

/// Keeps all memory of the program resident, now and later; gives what is in the way, with the cure.
///
/// It is not tried below a limit (`may_lock` is false then): an allocation that would go beyond it later would end the program.
#[cfg(target_os = "linux")]
pub fn lock(may_lock: bool) -> Result<(), KioskError> {
    use nix::sys::mman::{MlockAllFlags, mlockall};
    if !may_lock {
        return Err(KioskError::Device(
            "memory is not locked, because the limit `memlock` is not unlimited; set LimitMEMLOCK=infinity".into(),
        ));
    }
    mlockall(MlockAllFlags::MCL_CURRENT | MlockAllFlags::MCL_FUTURE)
        .map_err(|e| KioskError::Device(format!("memory is not locked ({e}); set lock_memory = false or add memory")))
}

/// Elsewhere there is no such call here.
///
/// # Errors
/// Always.
#[cfg(not(target_os = "linux"))]
pub fn lock(_may_lock: bool) -> Result<(), KioskError> {
    Err(KioskError::Device("memory is not locked, which Toile does on Linux alone; set lock_memory = false".into()))
}
