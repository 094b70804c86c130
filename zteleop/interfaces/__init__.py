"""What messages are called and how they look from outside."""
