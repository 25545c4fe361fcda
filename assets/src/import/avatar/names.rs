//! Names of joints in other tools: one table a dialect. The first name of each joint gives its place, all of them its skin weights.
//!
//! Standards: ISO/IEC 19774 (H-Anim) versions 1 and 2, VRM 0.x and 1.0 humanoid; habits: Mixamo and the FBX rigs named
//! alike, Unreal (also MakeHuman's game engine rig), MakeHuman's CMU rig, and the BVH files of the CMU database.

use toile_base::skeleton::{JOINTS, Joint};

/// How one family of tools names the joints.
#[derive(Debug)]
pub struct NamingDialect {
    /// Name of the dialect.
    pub title: &'static str,
    /// Names of each joint, in the order of [`Joint::ALL`]; `@` stands for the side and is filled in by `sides`.
    names: [&'static [&'static str]; CENTRE + ONE_SIDE],
    /// Words for left and right.
    sides: [&'static str; 2],
}

/// Joints on the midline, and on one side.
const CENTRE: usize = 5;
const ONE_SIDE: usize = (JOINTS - CENTRE) / 2;

/// The names of H-Anim version 2, which exports write.
pub const HANIM: &NamingDialect = &DIALECTS[1];

/// The dialects; where two fit equally well the earlier one is taken.
pub const DIALECTS: [NamingDialect; 7] = [
    NamingDialect {
        title: "VRM",
        names: [
            &["hips"],
            &["spine"],
            &["chest"],
            &["neck"],
            &["head"],
            &["@Shoulder"],
            &["@UpperArm"],
            &["@LowerArm"],
            &["@Hand"],
            &["@MiddleProximal", "@IndexProximal", "@RingProximal", "@LittleProximal"],
            &["@UpperLeg"],
            &["@LowerLeg"],
            &["@Foot"],
            &["@Toes"],
        ],
        sides: ["left", "right"],
    },
    NamingDialect {
        title: "H-Anim 2",
        names: [
            &["sacroiliac", "humanoid_root"],
            &["vl5"],
            &["vl1"],
            &["vc4"],
            &["skullbase"],
            &["@sternoclavicular"],
            &["@shoulder"],
            &["@elbow"],
            &["@radiocarpal"],
            &["@metacarpophalangeal_3", "@metacarpophalangeal_2", "@metacarpophalangeal_4", "@metacarpophalangeal_5"],
            &["@hip"],
            &["@knee"],
            &["@talocrural"],
            &["@metatarsophalangeal"],
        ],
        sides: ["l_", "r_"],
    },
    NamingDialect {
        title: "H-Anim 1",
        names: [
            &["sacroiliac", "HumanoidRoot"],
            &["vl5"],
            &["vl1"],
            &["vc4"],
            &["skullbase"],
            &["@sternoclavicular"],
            &["@shoulder"],
            &["@elbow"],
            &["@wrist"],
            &["@middle1", "@index1", "@ring1", "@pinky1"],
            &["@hip"],
            &["@knee"],
            &["@ankle"],
            &["@midtarsal"],
        ],
        sides: ["l_", "r_"],
    },
    NamingDialect {
        title: "Mixamo",
        names: [
            &["Hips"],
            &["Spine"],
            &["Spine1"],
            &["Neck"],
            &["Head"],
            &["@Shoulder"],
            &["@Arm"],
            &["@ForeArm"],
            &["@Hand"],
            &["@HandMiddle1", "@HandIndex1", "@HandRing1", "@HandPinky1"],
            &["@UpLeg"],
            &["@Leg"],
            &["@Foot"],
            &["@ToeBase"],
        ],
        sides: ["Left", "Right"],
    },
    NamingDialect {
        title: "Unreal",
        names: [
            &["pelvis"],
            &["spine_01"],
            &["spine_02"],
            &["neck_01"],
            &["head"],
            &["clavicle_@"],
            &["upperarm_@"],
            &["lowerarm_@"],
            &["hand_@"],
            &["middle_01_@", "index_01_@", "ring_01_@", "pinky_01_@"],
            &["thigh_@"],
            &["calf_@"],
            &["foot_@"],
            &["ball_@"],
        ],
        sides: ["l", "r"],
    },
    NamingDialect {
        title: "MakeHuman CMU",
        names: [
            &["Hips"],
            &["LowerBack"],
            &["Spine"],
            &["Neck"],
            &["Head"],
            &["@Shoulder"],
            &["@Arm"],
            &["@ForeArm"],
            &["@Hand"],
            &["@FingerBase"],
            &["@UpLeg"],
            &["@Leg"],
            &["@Foot"],
            &["@ToeBase"],
        ],
        sides: ["Left", "Right"],
    },
    NamingDialect {
        title: "CMU BVH",
        names: [
            &["Hips"],
            &["lowerback"],
            &["Chest"],
            &["Neck"],
            &["Head"],
            &["@Collar"],
            &["@Shoulder"],
            &["@Elbow"],
            &["@Wrist"],
            &["@Fingers"],
            &["@Hip"],
            &["@Knee"],
            &["@Ankle"],
            &["@Toe"],
        ],
        sides: ["Left", "Right"],
    },
];

/// Joints without which no body can be posed; all others can be placed between these.
pub const NEEDED: [Joint; 15] = {
    use Joint::*;
    [
        Pelvis,
        Spine,
        Head,
        LeftShoulder,
        LeftElbow,
        LeftWrist,
        LeftHip,
        LeftKnee,
        LeftAnkle,
        RightShoulder,
        RightElbow,
        RightWrist,
        RightHip,
        RightKnee,
        RightAnkle,
    ]
};

impl NamingDialect {
    /// The names of one joint, the one that gives its place first.
    pub fn names(&self, joint: Joint) -> Vec<String> {
        let i = joint.index();
        let (row, side) = if i < CENTRE { (i, 0) } else { (CENTRE + (i - CENTRE) % ONE_SIDE, (i - CENTRE) / ONE_SIDE) };
        self.names[row].iter().map(|name| name.replace('@', self.sides[side])).collect()
    }

    /// The joint that each name means, and whether the name is the one that gives its place.
    fn read(&self, names: &[String]) -> Vec<Option<Joint>> {
        let known: Vec<(String, Joint)> =
            Joint::ALL.into_iter().flat_map(|j| self.names(j).into_iter().map(move |n| (plain(&n), j))).collect();
        names.iter().map(|name| known.iter().find(|(n, _)| n == name).map(|(_, joint)| *joint)).collect()
    }
}

/// A name without namespace, case and punctuation: `mixamorig:LeftUpLeg` is `leftupleg`.
fn plain(name: &str) -> String {
    let name = name.rsplit([':', '|']).next().unwrap_or(name);
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// The joints that names mean, in the dialect that knows the most of the needed ones.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedJoints {
    /// Name of the dialect: whose names the joints bear, such as Mixamo's.
    pub dialect: &'static str,
    /// The joint that each name means `[names]`; several may mean the same one.
    pub joints: Vec<Option<Joint>>,
    /// The name that gives each joint its place `[JOINTS]`.
    pub places: [Option<usize>; JOINTS],
}

/// Reads the names of a skeleton.
pub fn read(names: &[&str]) -> NamedJoints {
    let names: Vec<String> = names.iter().map(|n| plain(n)).collect();
    let mut best: Option<(usize, NamedJoints)> = None;
    for dialect in &DIALECTS {
        let joints = dialect.read(&names);
        let place = |joint: Joint| {
            let mut wanted = dialect.names(joint).into_iter().map(|n| plain(&n));
            wanted.find_map(|w| names.iter().position(|n| *n == w))
        };
        let places = Joint::ALL.map(place);
        // Needed joints count more than all others together.
        let known = places.iter().flatten().count();
        let score = known + JOINTS * NEEDED.iter().filter(|j| places[j.index()].is_some()).count();
        if best.as_ref().is_none_or(|(most, _)| score > *most) {
            best = Some((score, NamedJoints { dialect: dialect.title, joints, places }));
        }
    }
    best.map_or_else(
        || NamedJoints { dialect: "none", joints: Vec::new(), places: [None; JOINTS] },
        |(_, reading)| reading,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_dialect_reads_its_own_names_back() {
        for dialect in &DIALECTS {
            let names: Vec<String> = Joint::ALL.into_iter().map(|j| dialect.names(j).remove(0)).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let reading = read(&names);
            assert_eq!(reading.joints, Joint::ALL.map(Some), "{} read as {}", dialect.title, reading.dialect);
        }
    }

    #[test]
    fn exports_are_read_back_by_their_own_names() {
        let vrm = &DIALECTS[0];
        for joint in Joint::ALL {
            assert_eq!(HANIM.names(joint)[0], joint.hanim());
            assert_eq!(vrm.names(joint)[0], joint.vrm());
        }
    }

    #[test]
    fn namespaces_case_and_marks_do_not_matter() {
        for name in ["mixamorig:LeftUpLeg", "mixamorig7:leftupleg", "Armature|Left_Up.Leg"] {
            assert_eq!(plain(name), "leftupleg");
        }
    }

    #[test]
    fn fingers_but_not_the_thumb_go_with_the_knuckles() {
        let mut names: Vec<String> = Joint::ALL.into_iter().map(|j| DIALECTS[4].names(j).remove(0)).collect();
        names.extend(["pinky_01_l".to_owned(), "thumb_01_l".to_owned()]);
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let reading = read(&names);
        assert_eq!(reading.joints[JOINTS..], [Some(Joint::LeftHand), None]);
        assert_eq!(reading.places[Joint::LeftHand.index()], Some(Joint::LeftHand.index()));
    }

    /// The joint map of the shared data: what its columns say about each of our joints is in our tables.
    #[test]
    fn the_tables_agree_with_the_joint_map() {
        let Some(folder) = crate::recordings::folder() else { return };
        let text = std::fs::read_to_string(folder.join("protocols/joint_map.csv")).unwrap();
        let mut rows = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let head = rows.next().unwrap();
        let columns = [
            ("vrm_bone", 0),
            ("hanim_v2", 1),
            ("hanim_v1", 2),
            ("fair_bvh", 3),
            ("hm08_game_engine", 4),
            ("hm08_cmu_mb", 5),
            ("cmu_bvh", 6),
        ];
        let mut checked = 0;
        for row in rows {
            let joint = Joint::ALL.into_iter().find(|j| HANIM.names(*j)[0] == row[0]);
            for (column, dialect) in columns {
                let cell = row[head.iter().position(|h| *h == column).unwrap()];
                let read = DIALECTS[dialect].read(&[plain(cell)])[0];
                match joint {
                    Some(joint) => assert_eq!(read, Some(joint), "{column}: {cell}"),
                    // The root stands above the pelvis; the upper chest is part of the chest.
                    None if row[0] == "humanoid_root" => assert!(matches!(read, None | Some(Joint::Pelvis)), "{cell}"),
                    None => assert_eq!((row[0], read), ("vt6", None), "{column}: {cell}"),
                }
                checked += 1;
            }
        }
        assert_eq!(checked, 23 * columns.len());
    }
}
