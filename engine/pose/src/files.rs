//! The networks' files: their names, their search path, and the commands that fetch them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

use hmac_sha256::Hash;

/// Folder of the files, where it is not [`OWN_FOLDER`].
pub const FOLDER_VARIABLE: &str = "TOILE_POSE_NETWORK";

/// Where the files are put.
pub const OWN_FOLDER: &str = "/usr/local/lib/toile/pose";

/// The one command that fetches the pose network's files and checks the package's hash.
pub const FETCH: &str = "cd $(mktemp -d) && npm pack --silent @mediapipe/pose@0.5.1675469404 && \
                         echo '8bb349a7b3a3ba699df23be804ddd3b3eab810b50b15406894be257859388a84 *mediapipe-pose-0.5.1675469404.tgz' \
                         | sha256sum --check --quiet && sudo mkdir -p /usr/local/lib/toile/pose && sudo tar --extract --gzip \
                         --file mediapipe-pose-0.5.1675469404.tgz --no-same-owner --strip-components=1 --directory \
                         /usr/local/lib/toile/pose package/pose_landmark_lite.tflite package/pose_landmark_full.tflite \
                         package/pose_solution_packed_assets.data && sudo chmod --recursive a+rX /usr/local/lib/toile/pose";

/// The one command that fetches the face network's file and checks the package's hash.
pub const FETCH_FACE: &str = "cd $(mktemp -d) && npm pack --silent @mediapipe/face_mesh@0.4.1657299874 && \
                              echo 'c08a7e0742a326285da666cf81d77c8b6f3a181a2ee948cadaf166008e0d3bc7 *mediapipe-face_mesh-0.4.1657299874.tgz' \
                              | sha256sum --check --quiet && sudo mkdir -p /usr/local/lib/toile/pose && sudo tar --extract --gzip \
                              --file mediapipe-face_mesh-0.4.1657299874.tgz --no-same-owner --strip-components=1 --directory \
                              /usr/local/lib/toile/pose package/face_mesh_solution_packed_assets.data && \
                              sudo chmod --recursive a+rX /usr/local/lib/toile/pose";

toile_base::named! {
    /// Networks, each of which comes in a package of its own.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum NetworkPackage {
        /// Finds joints in a webcam's pictures.
        Pose = "pose network",
        /// Finds the points of a face.
        Face = "face network",
    }
}

impl NetworkPackage {
    /// The one command that fetches its files and checks the package's hash.
    pub const fn fetch(self) -> &'static str {
        match self {
            Self::Pose => FETCH,
            Self::Face => FETCH_FACE,
        }
    }

    /// What needs it, in a sentence.
    const fn needed_by(self) -> &'static str {
        match self {
            Self::Pose => "a webcam",
            Self::Face => "a shopper's own face",
        }
    }

    /// Whether all its files are there, whole and known.
    ///
    /// # Errors
    /// The first that is not.
    pub fn check(self, folder: &Path) -> Result<(), PoseError> {
        PoseFile::ALL.into_iter().filter(|f| f.package() == self).try_for_each(|f| f.read(folder).map(|_| ()))
    }
}

toile_base::named! {
    /// Files of the networks.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum PoseFile {
        /// Landmarks, the small network.
        Lite = "lite",
        /// Landmarks, the larger one.
        Full = "full",
        /// Where a person is.
        Detector = "detector",
        /// A face's detector and points, two networks in one file.
        Face = "face",
    }
}

impl PoseFile {
    /// Its name in the package.
    pub const fn file_name(self) -> &'static str {
        match self {
            Self::Lite => "pose_landmark_lite.tflite",
            Self::Full => "pose_landmark_full.tflite",
            Self::Detector => "pose_solution_packed_assets.data",
            Self::Face => "face_mesh_solution_packed_assets.data",
        }
    }

    /// The package that it comes in.
    pub const fn package(self) -> NetworkPackage {
        match self {
            Self::Lite | Self::Full | Self::Detector => NetworkPackage::Pose,
            Self::Face => NetworkPackage::Face,
        }
    }

    /// Its size (bytes).
    const fn size(self) -> u64 {
        match self {
            Self::Lite => 2_819_824,
            Self::Full => 6_440_512,
            Self::Detector => 2_962_288,
            Self::Face => 3_986_256,
        }
    }

    const fn sha256(self) -> &'static str {
        match self {
            Self::Lite => "f17bfbecadb61c3be1baa8b8d851cc6619c870a87167b32848ad20db306b9d61",
            Self::Full => "e9a5c5cb17f736fafd4c2ec1da3b3d331d6edbe8a0d32395855aeb2cdfd64b9f",
            Self::Detector => "a63c614bef30d35947f13be361820b1e4e3bec9cfeebf4d11216a18373108e85",
            Self::Face => "dbe5905c582c0462cdaea17e7e6ecea92edaa8cccc515c5e2e7291f2cbb5fb99",
        }
    }

    /// That the file of a folder is another one: in what it differs.
    pub fn another(self, folder: &Path, what: String) -> PoseError {
        PoseError::Another { path: folder.join(self.file_name()), what, file: self }
    }

    /// Its bytes, from a folder.
    ///
    /// # Errors
    /// A file that is missing, cannot be read, or is another one: with the command that fetches it.
    pub fn read(self, folder: &Path) -> Result<Vec<u8>, PoseError> {
        let path = folder.join(self.file_name());
        let refused = |e: io::Error| match e.kind() {
            io::ErrorKind::NotFound => PoseError::Missing { folder: folder.to_path_buf(), file: self },
            _ => PoseError::Unreadable { path: path.clone(), problem: e.to_string(), file: self },
        };
        // The size first: whatever has this name may be larger than memory.
        let found = fs::metadata(&path).map_err(refused)?.len();
        let other = |what: String| self.another(folder, what);
        if found != self.size() {
            return Err(other(format!("it has {found} bytes instead of {}", self.size())));
        }
        let bytes = fs::read(&path).map_err(refused)?;
        let hash = Hash::hash(&bytes).iter().fold(String::new(), |mut hex, byte| {
            let _ = write!(hex, "{byte:02x}");
            hex
        });
        if hash == self.sha256() { Ok(bytes) } else { Err(other(format!("its SHA-256 begins with {}", &hash[..8]))) }
    }
}

/// Why there is no network.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PoseError {
    /// A file is not there.
    #[error(
        "{} needs the {} of MediaPipe, and {} holds no {}; fetch it: `{}`",
        file.package().needed_by(), file.package(), folder.display(), file.file_name(), file.package().fetch()
    )]
    Missing {
        /// The folder in which it was sought.
        folder: PathBuf,
        /// The file.
        file: PoseFile,
    },
    /// A file cannot be read.
    #[error(
        "{} cannot be read ({problem}); give it its rights or fetch it again: `{}`",
        path.display(), file.package().fetch()
    )]
    Unreadable {
        /// Path of the file.
        path: PathBuf,
        /// What the system says.
        problem: String,
        /// The file.
        file: PoseFile,
    },
    /// A file is not the one that is known.
    #[error(
        "{} is not the {} that is known: {what}; fetch it again: `{}`",
        path.display(), file.package(), file.package().fetch()
    )]
    Another {
        /// Path of the file.
        path: PathBuf,
        /// In what it differs.
        what: String,
        /// The file that it should be.
        file: PoseFile,
    },
}

impl PoseError {
    /// What is wrong, without the cure.
    pub fn what(&self) -> String {
        match self {
            Self::Missing { folder, file } => format!("{} holds no {}", folder.display(), file.file_name()),
            Self::Unreadable { path, problem, .. } => format!("{} cannot be read ({problem})", path.display()),
            Self::Another { path, what, .. } => format!("{} is another file: {what}", path.display()),
        }
    }
}

/// The folder of the environment, or Toile's own.
pub fn folder() -> PathBuf {
    let given = env::var_os(FOLDER_VARIABLE).filter(|folder| !folder.is_empty());
    given.map_or_else(|| PathBuf::from(OWN_FOLDER), PathBuf::from)
}

/// Whether all files of the pose network are there, whole and known.
///
/// # Errors
/// The first that is not.
pub fn check(folder: &Path) -> Result<(), PoseError> {
    NetworkPackage::Pose.check(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder of a test's own, taken away at its end.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let folder = env::temp_dir().join(format!("toile-pose-{}-{name}", std::process::id()));
            fs::create_dir_all(&folder).unwrap();
            Self(folder)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn a_network_that_is_not_there_is_named_with_the_command_that_fetches_it() {
        let error = check(Path::new("no/such")).unwrap_err().to_string();
        assert!(error.contains("no/such holds no pose_landmark_lite.tflite; fetch it: `cd $(mktemp"), "{error}");
        for package in NetworkPackage::ALL {
            let fetch = package.fetch();
            assert!(!fetch.contains("  ") && !fetch.contains('\n'), "errors are one line with single spaces: {fetch}");
        }
        let error = NetworkPackage::Face.check(Path::new("no/such")).unwrap_err().to_string();
        let words = "a shopper's own face needs the face network of MediaPipe, and no/such holds no face_mesh_solution";
        assert!(error.starts_with(words) && error.contains("npm pack --silent @mediapipe/face_mesh@"), "{error}");
    }

    #[test]
    fn a_file_of_another_size_or_content_is_refused() {
        let folder = Folder::new("another");
        let path = folder.0.join(PoseFile::Lite.file_name());
        fs::write(&path, "short").unwrap();
        let error = PoseFile::Lite.read(&folder.0).unwrap_err().to_string();
        assert!(error.contains("it has 5 bytes instead of 2819824"), "{error}");
        fs::write(&path, vec![0; PoseFile::Lite.size() as usize]).unwrap();
        let error = PoseFile::Lite.read(&folder.0).unwrap_err().to_string();
        assert!(error.contains("its SHA-256 begins with "), "{error}");
    }
}
