//! The address at which pictures to take away are served, if they are.

use std::net::{IpAddr, SocketAddr};

use serde::Deserialize;

/// Longest name of a network (bytes): that of a wireless one (IEEE 802.11).
const LONGEST_NAME: usize = 32;

/// A picture that a shopper takes away: by a link on the shop's own network, where that is asked for.
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PictureConfig {
    /// This machine's address and port on that network; none serves nothing, and codes hold the picture itself.
    pub serve: Option<SocketAddr>,
    /// Name of the network, as phones list it.
    pub network: Option<String>,
}

impl PictureConfig {
    /// The first value that cannot be, with the cure.
    pub fn fault(&self) -> Option<String> {
        let name = self.network.as_deref().unwrap_or("shop");
        if name.trim().is_empty() || name.len() > LONGEST_NAME || name.chars().any(char::is_control) {
            return Some(format!(
                "picture.network = {name:?} is no name of a network (1 .. {LONGEST_NAME} bytes); correct it"
            ));
        }
        let address = self.serve?;
        if address.port() == 0 {
            return Some(format!("picture.serve = {address} has no port; add one, such as {}:8080", address.ip()));
        }
        (!is_local(address.ip())).then(|| {
            format!("picture.serve = {address} is not an address of a shop's own network; give this machine's, such as 192.168.10.1:8080")
        })
    }
}

/// Whether an address is of a network that the internet does not reach (RFC 1918, RFC 3927, RFC 4193), or of this machine alone.
fn is_local(address: IpAddr) -> bool {
    match address {
        IpAddr::V4(v4) => v4.is_private() || v4.is_link_local() || v4.is_loopback(),
        IpAddr::V6(v6) => v6.is_unique_local() || v6.is_loopback(),
    }
}

/// Whether shoppers see themselves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OwnPictureUse {
    /// The mannequin alone; the camera's colour is not even asked for.
    Never,
    /// The mannequin first; on request the visitor sees themselves.
    #[default]
    Offered,
    /// The visitor themselves first; on request they see the mannequin.
    First,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(serve: &str, network: Option<&str>) -> Option<String> {
        let config = PictureConfig { serve: Some(serve.parse().unwrap()), network: network.map(Into::into) };
        config.fault()
    }

    #[test]
    fn only_addresses_of_a_shops_own_network_are_served_at() {
        for good in ["192.168.10.1:8080", "10.0.0.7:80", "172.16.3.4:8080", "127.0.0.1:8080", "[fd00::7]:8080"] {
            assert_eq!(fault(good, Some("Shop guest")), None, "{good}");
        }
        for bad in ["0.0.0.0:8080", "8.8.8.8:8080", "[2001:db8::1]:80", "224.0.0.1:8080"] {
            let message = fault(bad, None).unwrap();
            assert!(message.contains("own network") && message.contains(bad), "{message}");
        }
        assert!(fault("10.0.0.7:0", None).unwrap().contains("no port"));
        assert!(fault("10.0.0.7:80", Some(" ")).unwrap().contains("no name"));
        assert!(fault("10.0.0.7:80", Some(&"x".repeat(33))).is_some());
        assert_eq!(PictureConfig::default().fault(), None);
    }
}
