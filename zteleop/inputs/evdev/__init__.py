"""Linux event devices: keyboards and pads as the kernel has them, with every release."""
