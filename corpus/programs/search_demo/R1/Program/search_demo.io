; the finger touches a part some time after the search began; the gripper tells what it holds
on OUT[1]=TRUE  after 0.9 IN[1]=TRUE
on OUT[1]=FALSE after 0.1 IN[1]=FALSE
on OUT[2]=TRUE  after 0.2 IN[2]=TRUE
on OUT[2]=FALSE after 0.1 IN[2]=FALSE
