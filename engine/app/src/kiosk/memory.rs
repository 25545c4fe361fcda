//! Memory that stays: no step waits for a page, and what is known of a shopper is never swapped to a disk.

use crate::exit::AppError;

/// Keeps all memory of the program resident, now and later; gives what is in the way, with the cure.
///
/// It is not tried below a limit: an allocation that would go beyond it later would end the program.
#[cfg(target_os = "linux")]
pub fn lock() -> Result<(), AppError> {
    use nix::sys::mman::{MlockAllFlags, mlockall};
    if !crate::commands::doctor::may_lock_all() {
        return Err(AppError::Device(
            "memory is not locked, because the limit `memlock` is not unlimited; set LimitMEMLOCK=infinity".into(),
        ));
    }
    mlockall(MlockAllFlags::MCL_CURRENT | MlockAllFlags::MCL_FUTURE)
        .map_err(|e| AppError::Device(format!("memory is not locked ({e}); set lock_memory = false or add memory")))
}

/// Elsewhere there is no such call here.
///
/// # Errors
/// Always.
#[cfg(not(target_os = "linux"))]
pub fn lock() -> Result<(), AppError> {
    Err(AppError::Device("memory is not locked, which Toile does on Linux alone; set lock_memory = false".into()))
}
