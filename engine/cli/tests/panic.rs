//! A fault of Toile's own, alone in its process, because the panic hook and its flag belong to the whole process.

use std::fs;

use toile_cli::exit::{Code, install_panic_hook};
use toile_cli::output::OutputFolder;
use toile_cli::program::guarded;

#[test]
fn a_panic_on_any_thread_exits_70_and_takes_unfinished_files_back() {
    install_panic_hook();
    assert_eq!(guarded(|| Ok(())), Code::Ok);

    // A worker's panic fails the run even where no caller asks how the worker ended.
    let worker = guarded(|| {
        let ended = std::thread::spawn(|| panic!("a worker's fault")).join();
        assert!(ended.is_err());
        Ok(())
    });
    assert_eq!(worker, Code::Internal);

    let folder = std::env::temp_dir().join(format!("toile-panic-{}", std::process::id()));
    let own = guarded(|| {
        let mut out = OutputFolder::prepare(&folder)?;
        out.write("half.txt", b"half")?;
        panic!("a fault between two files");
    });
    assert_eq!(own, Code::Internal);
    assert!(fs::metadata(&folder).is_err(), "the folder was made for this run, and goes with it");
}
