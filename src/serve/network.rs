//! Networks of IP addresses, as in `10.0.0.0/8`.
//!
//! Pure.

use std::net::IpAddr;
use std::str::FromStr;

/// A network: the addresses that share a prefix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Network {
    address: IpAddr,
    prefix: u8,
}

impl Network {
    /// Returns whether an address is in the network.
    pub(super) fn contains(self, address: IpAddr) -> bool {
        // An IPv4 client of an IPv6 socket has an address such as `::ffff:10.0.0.1`.
        let (bits, own_bits) = match (address.to_canonical(), self.address) {
            (IpAddr::V4(address), IpAddr::V4(own)) => {
                (u128::from(address.to_bits()) << 96, u128::from(own.to_bits()) << 96)
            }
            (IpAddr::V6(address), IpAddr::V6(own)) => (address.to_bits(), own.to_bits()),
            _ => return false,
        };
        // The shift by 128 of an empty prefix gives `None`: all addresses share it.
        (bits ^ own_bits).checked_shr(128 - u32::from(self.prefix)).unwrap_or(0) == 0
    }
}

/// Parses an address, with or without the length of the prefix.
impl FromStr for Network {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || "expected a network, such as 10.0.0.0/8 or fd00::/8, or an address".to_owned();
        let (address, prefix) = text.split_once('/').map_or((text, None), |(address, prefix)| (address, Some(prefix)));
        let address: IpAddr = address.parse().map_err(|_| wrong())?;
        let most = if address.is_ipv4() { 32 } else { 128 };
        let prefix = prefix.map_or(Ok(most), |prefix| prefix.parse().map_err(|_| wrong()))?;
        if prefix > most {
            return Err(format!("the prefix of this network has at most {most} bits, not {prefix}"));
        }
        Ok(Self { address, prefix })
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
